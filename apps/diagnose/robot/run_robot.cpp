#include "run_robot.hpp"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <optional>
#include <utility>

#include "../../common/interrupt.hpp"
#include "../progress.hpp"
#include "../results.hpp"
#include "diagnose_robot.hpp"
#include "numerical_error.hpp"
#include "robot_files.hpp"
#include "setup_guess.hpp"
#include "stuck_sensor.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/core/error.hpp"
#include "swapped_joints.hpp"
#include "swapped_torques.hpp"
#include "torque_hold.hpp"
#include "torque_scale.hpp"
#include "xml_text.hpp"

namespace diagnose_robot {
namespace {

constexpr int exit_done = 0, exit_interrupted = 130;

// Errors of augmented.xml in MuJoCo itself, over all recordings.
double replay_error(const Evidence& evidence, const AugmentedModel& augmented, const RobotDiagnosis& d) {
  Eigen::MatrixXd errors(static_cast<Eigen::Index>(evidence.block.size()),
                         static_cast<Eigen::Index>(evidence.robot.joints.size()));
  Eigen::Index at = 0;
  for (std::size_t r = 0; r < evidence.recordings.size(); ++r) {
    const RobotRecording& recording = evidence.recordings[r];
    errors.middleRows(at, recording.time.size()) =
        recording.angle - replay(evidence.robot, augmented, d.physics, recording, d.starts[r]);
    leave_out_start(evidence.robot, recording, errors.middleRows(at, recording.time.size()));
    at += recording.time.size();
  }
  const Eigen::VectorXd rms = rms_by_joint(evidence, errors);
  return std::sqrt(rms.squaredNorm() / static_cast<double>(rms.size()));
}

// With the longest step of MuJoCo that replays to the stated error, else with the one that comes nearest.
AugmentedModel augmented_and_replayed(const Evidence& evidence, const std::filesystem::path& folder,
                                      RobotDiagnosis& d) {
  constexpr double same = 0.01;  // of the error
  AugmentedModel best;
  double nearest = std::numeric_limits<double>::infinity();
  for (const double steps : steps_of_ours) {
    AugmentedModel model = augmented_model(evidence.robot, d.physics, d.step / steps, folder);
    const double replayed = d.torque_driven ? std::nan("") : replay_error(evidence, model, d);
    const double off = std::abs(replayed / d.after - 1);
    if (off < nearest || best.xml.empty()) {
      nearest = off;
      d.replayed = replayed;
      best = std::move(model);
    }
    if (d.torque_driven || off < same || evidence.stop.stop_requested()) break;
  }
  d.augmented = best.table;
  return best;
}

void load_recordings(const diagnose_program::CommandLine& line, Evidence& evidence, std::vector<std::string>& remarks) {
  std::size_t rows = line.max_rows;
  for (const std::filesystem::path& file : line.recordings) {
    if (rows == 0) break;
    evidence.recordings.push_back(read_recording(diagnose_program::read_csv(file), evidence.robot.setup, rows));
    rows -= std::min(rows, static_cast<std::size_t>(evidence.recordings.back().time.size()));
    for (const std::string& remark : check_recording(evidence.robot, evidence.recordings.back()))
      remarks.push_back(remark);
    evidence.motions.push_back(smooth(evidence.recordings.back()));
    const std::string stuck = stuck_sensor(evidence, evidence.motions.size() - 1);
    if (!stuck.empty()) throw surefoot::DiagnoseError(stuck);
  }
  prepare(evidence);
  evidence.folder = line.model.parent_path();
  evidence.numerical = numerical_error(evidence, evidence.robot.nominal, evidence.starts);
}

// Recordings of --test, which took no part in anything, take the place of held-out blocks.
void evaluate_test(const diagnose_program::CommandLine& line, const Evidence& evidence, RobotDiagnosis& d) {
  if (line.test.empty()) return;
  Evidence test(evidence.robot);
  diagnose_program::CommandLine files = line;
  files.recordings.assign(line.test.begin(), line.test.end());
  std::vector<std::string> remarks;
  load_recordings(files, test, remarks);
  test.scales = evidence.scales;
  for (std::size_t r = 0; r < test.motions.size(); ++r)
    test.motions[r].torque_late = evidence.motions.front().torque_late;
  hold_out(test, d);
}

// Swapped columns, repaired in place if asked for.
std::vector<surefoot::LogFault> swapped_columns(bool repair, Evidence& evidence) {
  std::vector<surefoot::LogFault> faults;
  const bool torque = evidence.robot.setup.drive == DriveKind::torque;
  for (const auto& [a, b] : torque ? swapped_torques(evidence) : swapped_pairs(unexplained_commands(evidence))) {
    const JointSetup &one = evidence.robot.joints[static_cast<std::size_t>(a)].setup,
                     &other = evidence.robot.joints[static_cast<std::size_t>(b)].setup;
    surefoot::LogFault fault;
    fault.kind = "columns_swapped";
    fault.channel = one.angle.name;
    fault.sentence = one.angle.name + " and " + other.angle.name + " are swapped: each moves as the other is told";
    fault.cure = "swap them in the setup";
    fault.repaired = repair;
    faults.push_back(fault);
    if (!repair) continue;
    for (RobotRecording& recording : evidence.recordings) {
      for (Eigen::MatrixXd* readings : {&recording.angle, &recording.speed}) {
        if (readings->size() > 0) readings->col(a).swap(readings->col(b));
      }
    }
  }
  if (repair && !faults.empty()) {
    for (std::size_t r = 0; r < evidence.recordings.size(); ++r) evidence.motions[r] = smooth(evidence.recordings[r]);
    prepare(evidence);
  }
  return faults;
}

// Scales of torques are uncertain, as the setup may say, where the recordings refute the stated ones.
void allow_for_scales(Robot& robot, Evidence& evidence, std::vector<std::string>& remarks) {
  std::string list;
  for (const int j : joints_of_other_scale(evidence))
    list += (list.empty() ? "" : ", ") + robot.joints[static_cast<std::size_t>(j)].setup.torque.name;
  if (list.empty()) return;
  remarks.push_back(
      list +
      ": no torque of its joint in N m (or N), but on another scale, as a current of its motor, or of the "
      "other sign; scales of all torques are calibrated, as calibrate = [\"gains\"] asks for");
  robot.setup.calibrate_gains = true;
  prepare(evidence);
}

}  // namespace

int run_robot(const diagnose_program::CommandLine& line) {
  const auto begin = std::chrono::steady_clock::now();
  if (line.setup.empty()) {
    throw surefoot::DiagnoseError("a robot model needs --setup robot.toml; `surefoot-diagnose setup " +
                                  line.model.string() + " " + line.recordings.front().string() +
                                  " > robot.toml` writes a first one");
  }
  const RobotSetup setup = read_setup(line.setup);
  RobotModel model = load_robot(line.model);
  std::vector<std::string> remarks = model.remarks;
  Robot robot = bind_robot(std::move(model), setup);
  Evidence evidence(robot);
  example::Interrupt interrupt;
  evidence.threads = surefoot::Threads(line.threads);
  evidence.stop = interrupt.token();
  load_recordings(line, evidence, remarks);
  diagnose_program::prepare_folder(line.out);
  diagnose_program::Progress progress(line.quiet);
  const std::vector<surefoot::LogFault> faults = swapped_columns(line.repair, evidence);
  const bool usable = faults.empty() || line.repair;
  if (usable) allow_for_scales(robot, evidence, remarks);
  if (hold_torques(evidence)) {
    remarks.push_back(
        "recorded torques are taken as commands that stand until the next row: these recordings refute that they act "
        "as they are logged");
  }
  RobotDiagnosis d =
      usable
          ? diagnose_robot(evidence, [&](const std::string& stage, double share) { progress.show(stage, share, ""); })
          : refuse_log(evidence, faults);
  d.common.log_faults.insert(d.common.log_faults.begin(), faults.begin(), faults.end());
  evaluate_test(line, evidence, d);
  d.step = simulation_step(robot, evidence.recordings.front());
  const AugmentedModel augmented = augmented_and_replayed(evidence, line.model.parent_path(), d);
  progress.close();
  for (const std::string& remark : remarks) d.common.remarks.insert(d.common.remarks.begin(), {"", remark});
  d.common.seed = line.seed;
  d.common.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  surefoot::write_file_atomically(line.out / "augmented.xml", augmented.xml);
  surefoot::write_file_atomically(line.out / "augmented.hpp", augmented.header);
  surefoot::write_file_atomically(line.out / "report.html", robot_report(d));
  surefoot::write_file_atomically(line.out / "diagnosis.json", robot_json(d));
  if (!line.quiet) std::cout << robot_summary(d, (line.out / "report.html").string()) << std::flush;
  return d.common.complete ? exit_done : exit_interrupted;
}

int run_setup(int argc, const char* const* argv) {
  if (argc != 4)
    throw surefoot::DiagnoseError(
        "setup needs a model and a log: surefoot-diagnose setup robot.xml log.csv > robot.toml");
  const RobotModel model = load_robot(argv[2]);
  const SetupGuess guess = guess_setup(model, diagnose_program::read_csv(argv[3]));
  std::cout << setup_text(guess.setup, guess.remarks);
  return exit_done;
}

}  // namespace diagnose_robot

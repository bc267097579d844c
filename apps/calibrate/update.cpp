// `update`: keeps a calibrated motion model up to date, and raises the alarm when the robot walks no longer as
// calibrated.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "../common/files.hpp"
#include "commands.hpp"
#include "motion_file/motion_file.hpp"
#include "sequence_options.hpp"
#include "surefoot/motion/monitor.hpp"

namespace calibrate_program {
namespace {

struct UpdateOptions {
  SequenceOptions read;
  std::filesystem::path motion, out;
  double forgetting = 0.98;
  double threshold = 0;  // [nats], 0: found by simulation
};

surefoot::MotionTracker tracker_of(const MotionFile& file, double forgetting) {
  surefoot::ModelFitOptions options;
  options.accuracy = file.accuracy;
  surefoot::MotionTracker tracker =
      surefoot::track(default_model(file.kind).with_parameters(file.parameters), file.covariance, file.noise, options);
  tracker.forgetting = forgetting;
  return tracker;
}

void keep(const surefoot::MotionTracker& tracker, std::size_t sequences, std::size_t readings, MotionFile& file) {
  file.parameters = tracker.model.parameter_box().clamp(tracker.model.parameters());
  file.model = embedded(file.kind, file.parameters);
  file.covariance = tracker.covariance();
  file.covariance = (0.5 * (file.covariance + file.covariance.transpose())).eval();
  file.method = "update";
  file.sequences += sequences;
  file.readings += readings;
}

double threshold_of(const surefoot::MotionTracker& tracker, const LoadedSequences& loaded, const MotionFile& file,
                    const UpdateOptions& options, const StoppableThreads& executor) {
  if (options.threshold > 0) return options.threshold;
  say("finding what evidence an alarm must ask for, so that 1 of 100 runs of 100 sequences raises a false one");
  surefoot::ThresholdOptions work;
  const auto readings = static_cast<double>(std::max<std::size_t>(file.readings, 3));
  work.noise_error = 1 / std::sqrt(2 * readings / 3);
  return surefoot::alarm_threshold(tracker, loaded.sequences, work, executor, options.read.seed);
}

void update_by_all(const LoadedSequences& loaded, surefoot::ChangeAlarm& alarm) {
  std::printf("%-32s %16s %14s %10s\n", "sequence", "final error [m]", "surprise [sd]", "evidence");
  for (const surefoot::WalkSequence& sequence : loaded.sequences) {
    const double error = final_pose_error(alarm.tracker.model, std::span(&sequence, 1)).position;
    const surefoot::AlarmReport report = update(alarm, sequence);
    std::printf("%-32.32s %16.3f %14.1f %10.1f%s\n", sequence.name.c_str(), error, report.surprise.deviations(),
                report.evidence, report.outlier ? "  an outlier: not learnt from, a wrong reading?" : "");
    if (!report.change) continue;
    const auto since = static_cast<std::size_t>(report.change->since) - 1;
    std::printf("ALARM: the robot no longer walks as calibrated. %s (That is %s.) What changed is learnt anew.\n",
                describe(*report.change, alarm.tracker.model).c_str(), loaded.sequences[since].name.c_str());
    adapt(alarm, *report.change);
  }
}

void run(const UpdateOptions& options) {
  check(options.read);
  MotionFile file = read_motion_file(options.motion);
  LoadOptions load = options.read.load;
  load.usual_steps = file.steps_per_cycle;
  const LoadedSequences loaded = load_sequences(options.read.files, load);
  warn_of_skipped(loaded);
  example::prepare_output(options.out / "motion.json");
  until_interrupted(options.read.threads, [&](const StoppableThreads& executor) {
    surefoot::ChangeAlarm alarm{.tracker = tracker_of(file, options.forgetting)};
    alarm.threshold = threshold_of(alarm.tracker, loaded, file, options, executor);
    std::printf("An alarm is raised at an evidence of %.1f nats.\n", alarm.threshold);
    update_by_all(loaded, alarm);
    keep(alarm.tracker, loaded.sequences.size(), count_readings(loaded.sequences), file);
  });
  write_motion_file(options.out / "motion.json", file);
  std::printf("The model, brought up to date: %s\n", (options.out / "motion.json").c_str());
}

}  // namespace

void add_update(example::Command& program) {
  auto options = std::make_shared<UpdateOptions>();
  example::Command* command =
      program.add_subcommand("update", "Bring a model up to date with new sequences; alarm if the robot has changed");
  command->footer("Reads the same files as `fit`, in their order. Writes motion.json.");
  command->add_option("--motion", options->motion, "motion.json as `fit` or `update` wrote it")->required();
  add_reading_options(*command, options->read);
  command->add_option("--forgetting", options->forgetting, "factor per sequence; 1: everything is remembered")
      ->check(example::between(0.5, 1.0))
      ->capture_default_str();
  command
      ->add_option("--alarm-threshold", options->threshold,
                   "[nats] evidence of a change that raises the alarm; default: found by simulation")
      ->check(example::between(0.1, 1e6));
  command->add_option("--out", options->out, "folder for the new motion.json, made if needed")->required();
  add_work_options(*command, options->read);
  command->callback([options] { run(*options); });
}

}  // namespace calibrate_program

// Writes the seeds that no fixture gives: make_fuzz_seeds FOLDER, which is tests/fuzz/seeds.
#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "apps/calibrate/paper_robot.hpp"
#include "apps/calibrate/walk_csv.hpp"
#include "examples/sigmaban/robot/dynamixel/protocol1.hpp"
#include "examples/sigmaban/robot/dynamixel/protocol2.hpp"
#include "examples/sigmaban/robot/walk/joints_file.hpp"
#include "examples/sigmaban/robot/walk_engine/spline_walk.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/diagnose/residual_model.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/motion/plan.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "surefoot/optimize/cma_es.hpp"
#include "surefoot/optimize/cma_es_serialize.hpp"
#include "tests/apps/diagnose_models.hpp"

namespace {

std::filesystem::path root;

std::filesystem::path seed(const std::string& name) {
  std::filesystem::create_directories((root / name).parent_path());
  return root / name;
}

void write(const std::string& name, std::string_view text) { surefoot::write_file_atomically(seed(name), text); }

void write_packets() {
  std::array<std::uint8_t, 256> buffer{};
  std::string one, two;
  const auto add = [](std::string& stream, dynamixel::Bytes packet) { stream.append(packet.begin(), packet.end()); };
  const std::array<std::uint8_t, 4> data{0xFF, 0xFF, 0xFD, 7};  // must be stuffed
  for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{20}}) {
    add(one, dynamixel::protocol1::encode(buffer, id, 3, data));
    add(two, dynamixel::protocol2::encode(buffer, id, dynamixel::Instruction::write, data));
    add(two, dynamixel::protocol2::status(buffer, id, dynamixel::protocol2::Error::none, false, data));
    two += "\xFF\xFF noise \xFD";
  }
  write("dynamixel/protocol1.bin", one);
  write("dynamixel/protocol2.bin", two);
}

void write_residual() {
  surefoot::Dataset<Eigen::Dynamic, Eigen::Dynamic> samples;
  samples.inputs = Eigen::MatrixXf::Random(2, 60);
  samples.outputs = samples.inputs.cast<double>().cwiseAbs2();
  const auto forest = surefoot::train_extra_trees<surefoot::ConstantLeaf>(samples, {.trees = 2, .min_leaf = 12},
                                                                          surefoot::Serial{}, /*seed*/ 1);
  surefoot::save_residual_model({{"speed", "load"}, {"angle_rad", "speed_rad_s"}, Eigen::Vector2d(0.1, 2), forest},
                                seed("residual/two_outputs.residual"));
}

void write_search() {
  const surefoot::Box<Eigen::Dynamic> box{Eigen::Vector3d(-5, -5, 1), Eigen::Vector3d(5, 5, 1)};
  const auto waves = [](const Eigen::VectorXd& x) { return (x.array().square() - 10 * (6 * x.array()).cos()).sum(); };
  const surefoot::CmaEsOptions options{.restarts = surefoot::Restarts::bipop, .max_evaluations = 1500};
  const auto result =
      surefoot::cma_es(waves, Eigen::VectorXd(Eigen::Vector3d(2, 3, 1)), box, options, surefoot::Serial{}, /*seed*/ 3);
  surefoot::write_file_atomically(seed("search/restarted.cma"), surefoot::save(result.search));
}

void write_walks() {
  using namespace calibrate_program;
  const auto commands = surefoot::plan_commands(surefoot::CommandBounds(), /*sequences*/ 3, /*cycles*/ 2, /*seed*/ 1);
  const MotionFile robot = paper_robot();
  std::vector<surefoot::WalkSequence> walks;
  for (const auto& one : commands) {
    surefoot::Rng rng(1, walks.size());
    walks.push_back(simulate_walk(robot.model, robot.noise, surefoot::PoseAccuracy(),
                                  surefoot::planned_sequence(one, /*every_pose*/ true), rng));
    walks.back().name = std::to_string(walks.size());
  }
  write("walks/many.csv", walks_csv(walks, 2));
  write("walks/one.csv", "dx_m,dy_m,turn_deg,x_cm,y_cm,yaw_deg\n0.02,0,1,0,0,0\n0.02,0.01,2,,,\n0,0,0,5,1.5,4\n");
  write("walks/named.csv", "a_cm,b_m,c_deg,x_m,y_m\n1,0.01,2,0,0\n2,0,0,0.1,0.05\n");
  write("walks/wheels.csv",
        "t_s,v_left_m_s,v_right_m_s,x_m,y_m,yaw_rad\n0,0.1,0.3,1,2,3\n0.5,0.2,0.2,,,\n1.5,0,0,1,1,0\n");
  write("sheet/commands.csv", commands_csv(commands, 1));
  write("sheet/sheet.csv", "seq,x_cm,y_cm,heading_clock\n1,100,-20,3\n2,,,\n3,50,10,12\n");
  write("sheet/metres.csv", "seq,x_m,y_m,heading_deg\n1,1,-0.2,90\n3,0.5,0.1,\n");
}

void write_targets() {
  std::string text = "case,phase,step_m,lateral_m,turn_rad,rise_m,reachable";
  for (const auto name : sigmaban::joint_names) text += "," + std::string(name) + "_rad";
  for (const double phase : {0.0, 0.3, 0.8}) {
    sigmaban::SplineWalk engine({}, phase);
    const auto targets = engine.step({.forward = 0.03, .left = 0.01, .turn = 0.1}, 0);
    text += "\nwalk," + std::to_string(phase) + ",0.03,0.01,0.1,0.035," + (targets ? "1" : "0");
    for (std::size_t i = 0; i < sigmaban::joint_names.size(); ++i)
      text += "," + (targets ? std::to_string(targets->array()[i]) : std::string());
  }
  write("reference/walk.csv", text + "\n");
}

void make() {
  write_packets();
  write_residual();
  write_search();
  write("model/servo.toml", diagnose_test::servo_model);
  write("model/walk.toml", diagnose_test::walk_model);
  write("recording/servo.csv", diagnose_test::servo_csv);
  write("recording/walk.csv",
        "seq,order_m,turn_rad,x_m,y_m\n1,0.1,0,0.1,0\n1,0.1,0.2,0.2,0\n2,0.1,0,,\n2,0.1,0,0.2,0\n");
  write_walks();
  write("joints/default.json", sigmaban::joints_to_json(sigmaban::default_joints()));
  write_targets();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_fuzz_seeds FOLDER\n");
    return 2;
  }
  root = argv[1];
  try {
    make();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_fuzz_seeds: %s\n", error.what());
    return 1;
  }
}

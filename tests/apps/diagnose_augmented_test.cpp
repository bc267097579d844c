// augmented.hpp: compiled, it simulates what the program itself simulates.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "apps/diagnose/equations.hpp"
#include "apps/diagnose/known_effects.hpp"
#include "apps/diagnose/write_augmented.hpp"
#include "apps/diagnose/write_cpp.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#include "tests/apps/diagnose_models.hpp"
#include "tests/support/program.hpp"

namespace {

bool compiler_exists() { return std::system("command -v c++ pkg-config >/dev/null 2>&1") == 0; }

surefoot::Recording bench() {
  surefoot::Recording recording;
  recording.name = "rec.csv";
  recording.constants = {{"mass_kg", 0.5}, {"length_m", 0.1}, {"kp", 5}, {"vin_V", 7.4}};
  recording.time = Eigen::VectorXd::LinSpaced(200, 0, 1);
  recording.inputs = (3 * recording.time.array()).sin().matrix().transpose();
  recording.outputs = Eigen::MatrixXd::Zero(1, 200);
  recording.initial = recording.initial_scale = Eigen::Vector2d::Zero();
  return recording;
}

// Prints the simulated output of bench(), one number a line.
constexpr const char* printer = R"CPP(#include <cstdio>
#include "augmented.hpp"
                                      int main() {
                                        surefoot::Recording recording;
                                        recording.name = "rec.csv";
                                        recording.constants = {{"mass_kg", 0.5}, {"length_m", 0.1}, {"kp", 5}, {"vin_V", 7.4}};
                                        recording.time = Eigen::VectorXd::LinSpaced(200, 0, 1);
                                        recording.inputs = (3 * recording.time.array()).sin().matrix().transpose();
                                        recording.outputs = Eigen::MatrixXd::Zero(1, 200);
                                        recording.initial = recording.initial_scale = Eigen::Vector2d::Zero();
                                        const auto simulated = surefoot::simulate_augmented(augmented::Model{}, augmented::found(), recording);
                                        for (const double value : simulated.outputs.row(0)) std::printf("%.17g\n", value);
                                      }
)CPP";

}  // namespace

TEST_CASE("the augmented header compiles and simulates like the model file" * doctest::skip(!compiler_exists())) {
  using namespace diagnose_program;
  surefoot::Diagnosis diagnosis;
  diagnosis.integration_step = 0.002;
  diagnosis.parameters.push_back({{"kt", "N m/A", 1.5, 1.4, 1.6}, 1.6});
  diagnosis.effects.push_back({"coulomb_friction", "omega", "", {{"level", "N m", 0.12, 0.11, 0.13}}, {}, "", ""});
  diagnosis.effects.push_back({"saturation", "tau", "", {{"level", "1", 0.8, 0.7, 0.9}}, {}, "", ""});
  const ModelFile model = augmented_model(parse_model_file(diagnose_test::servo_model, "servo.toml"), diagnosis);

  surefoot::Augmented augmented;
  augmented.effects = known_effects(model, surefoot::all_effects());
  augmented.integration.step = 0.002;
  const auto expected = surefoot::simulate_augmented(OdeModel(model), augmented, bench());

  const approach_program::ScratchFolder folder;
  std::ofstream(folder.file("augmented.hpp")) << model_header(model, diagnosis);
  std::ofstream(folder.file("print.cpp")) << printer;
  const auto built = approach_program::run_command("c++ -std=c++20 -O0 -w -I" SUREFOOT_SOURCE_DIR
                                                   "/include $(pkg-config --cflags eigen3) " +
                                                   folder.file("print.cpp") + " -o " + folder.file("print"));
  CAPTURE(built.output);
  REQUIRE(built.code == 0);
  std::istringstream numbers(approach_program::run_command(folder.file("print")).output);
  for (Eigen::Index row = 0; row < expected.outputs.cols(); ++row) {
    double value = std::nan("");
    REQUIRE(static_cast<bool>(numbers >> value));
    CHECK(std::abs(value - expected.outputs(0, row)) < 1e-9);
  }
  CHECK(expected.outputs.cwiseAbs().maxCoeff() > 0.1);
}

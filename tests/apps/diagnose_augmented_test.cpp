// augmented.hpp: compiled, it simulates what the program itself simulates.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

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

// What the program prints that simulates with this header.
std::vector<double> printed_by(const std::string& header, const std::string& program) {
  const approach_program::ScratchFolder folder;
  std::ofstream(folder.file("augmented.hpp")) << header;
  std::ofstream(folder.file("print.cpp")) << program;
  const auto built = approach_program::run_command("c++ -std=c++20 -O0 -w -I" SUREFOOT_SOURCE_DIR
                                                   "/include $(pkg-config --cflags eigen3) " +
                                                   folder.file("print.cpp") + " -o " + folder.file("print"));
  CAPTURE(built.output);
  REQUIRE(built.code == 0);
  std::istringstream numbers(approach_program::run_command(folder.file("print")).output);
  return {std::istream_iterator<double>(numbers), std::istream_iterator<double>()};
}

// Asks a header's model for its response to forces, at one point.
constexpr const char* response_printer = R"CPP(#include <cstdio>
#include "augmented.hpp"
                                               int main() {
                                                 const Eigen::VectorXd p = Eigen::Vector2d(1.3, 0.4);
                                                 const augmented::Model::State x(1, 0.3, 0.7, -2), f(0, 0.6, 0, -1.1);
                                                 const augmented::Model::Input u(0.4);
                                                 const augmented::Model model;
                                                 for (const double one : model.response(x, u, p, f))
                                                   std::printf(
                                                       "%."
                                                       "17g"
                                                       "\n",
                                                       one);
                                                 for (const double one : model.derivative(x, u, p))
                                                   std::printf(
                                                       "%."
                                                       "17g\n",
                                                       one);
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
  using enum surefoot::InputHold;
  for (const surefoot::InputHold hold : {zero_order, linear, before, band_limited}) {
    diagnosis.input_holds = {hold};
    const ModelFile model = augmented_model(parse_model_file(diagnose_test::servo_model, "servo.toml"), diagnosis);
    surefoot::Augmented augmented;
    augmented.effects = known_effects(model, surefoot::all_effects());
    augmented.integration.step = 0.002;
    const auto expected = surefoot::simulate_augmented(OdeModel(model), augmented, bench());

    const std::vector<double> printed = printed_by(model_header(model, diagnosis), printer);
    REQUIRE(printed.size() == static_cast<std::size_t>(expected.outputs.cols()));
    for (Eigen::Index row = 0; row < expected.outputs.cols(); ++row) {
      CHECK(std::abs(printed[static_cast<std::size_t>(row)] - expected.outputs(0, row)) < 1e-9);
    }
    CHECK(expected.outputs.cwiseAbs().maxCoeff() > 0.1);
  }
}

TEST_CASE("in the augmented header, too, a force moves all velocities" * doctest::skip(!compiler_exists())) {
  using namespace diagnose_program;
  const surefoot::Diagnosis diagnosis;
  const ModelFile read = parse_model_file(diagnose_test::crane_model, "crane.toml");
  const ModelFile model = parse_model_file(model_text(augmented_model(read, diagnosis)), "augmented.toml");
  CHECK(model.states[1].force == "rub");
  CHECK(model.states[3].effort_unit == "N m");
  const std::vector<double> printed = printed_by(model_header(model, diagnosis), response_printer);
  OdeModel own(model);
  const Eigen::VectorXd p = Eigen::Vector2d(1.3, 0.4);
  own.prepare(p);
  Channels x(4), f(4), u(1);
  x << 1, 0.3, 0.7, -2;
  f << 0, 0.6, 0, -1.1;
  u << 0.4;
  const Channels response = own.response(x, u, p, f), rates = own.derivative(x, u, p);
  REQUIRE(printed.size() == 8);
  for (Eigen::Index i = 0; i < 4; ++i) {
    CHECK(printed[static_cast<std::size_t>(i)] == doctest::Approx(response[i]).epsilon(1e-12));
    CHECK(printed[static_cast<std::size_t>(4 + i)] == doctest::Approx(rates[i]).epsilon(1e-12));
  }
  CHECK(response[1] != 0);
}

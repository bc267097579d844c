// Effects on the displacement of steps in the plane, alone and on a walk that follows its orders.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/effects/body_drift.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/cross_coupling.hpp"
#include "surefoot/diagnose/effects/ground_slope.hpp"
#include "surefoot/diagnose/effects/slip_saturation.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"

namespace surefoot {
namespace {

constexpr double quarter = std::numbers::pi / 2;

// Walks in its own frame: forward and lateral [m], turn [rad].
struct Walk {
  using State = Vec<3>;
  using Input = Vec<3>;
  using Output = Vec<3>;

  SimulatorInfo info() const {
    return {.name = "walk",
            .kind = SimulatorKind::map,
            .states = {{"x", "m"}, {"y", "m"}, {"heading", "rad"}},
            .inputs = {{"forward", "m"}, {"lateral", "m"}, {"turn", "rad"}},
            .outputs = {{"x_m", "m"}, {"y_m", "m"}, {"heading_rad", "rad"}},
            .parameters = {},
            .planar = PlanarInfo{}};
  }
  State next(const State& x, const Input& u, const Eigen::VectorXd&) const {
    const double c = std::cos(x[2]), s = std::sin(x[2]);
    return {x[0] + c * u[0] - s * u[1], x[1] + s * u[0] + c * u[1], x[2] + u[2]};
  }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return x; }
};

// Ends of a walk of four equal steps.
Eigen::Vector3d walked(const Effect& effect, const std::vector<double>& values, const Eigen::Vector3d& step,
                       double heading = 0) {
  Recording recording;
  recording.name = "test";
  recording.time = Eigen::VectorXd::LinSpaced(5, 0, 4);
  recording.inputs = step.replicate(1, 5);
  recording.outputs = Eigen::MatrixXd::Zero(3, 5);
  recording.initial = Eigen::Vector3d(0, 0, heading);
  recording.initial_scale = Eigen::Vector3d::Zero();
  Augmented augmented;
  augmented.effects = {{.name = effect.name, .attached_to = "planar", .form = effect.form, .values = values}};
  return simulate_augmented(Walk{}, augmented, recording).states.col(4);
}

void check_close(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  CAPTURE(a.transpose());
  CAPTURE(b.transpose());
  CHECK((a - b).norm() < 1e-12);
}

TEST_CASE("slip shortens large steps of its own direction alone") {
  const Pose2 step{0.2, -0.1, 1};
  const auto slip = [&](const Effect& effect, double level) {
    const std::vector<double> p = {level};
    return effect.planar(step, 0.3, p).vec();
  };
  check_close(slip(effects::slip_saturation_forward(), 0.1), {0.1 * std::tanh(2.0), -0.1, 1});
  check_close(slip(effects::slip_saturation_lateral(), 0.1), {0.2, -0.1 * std::tanh(1.0), 1});
  check_close(slip(effects::slip_saturation_turn(), 2), {0.2, -0.1, 2 * std::tanh(0.5)});
}

TEST_CASE("a body drifts along with its heading") {
  check_close(walked(effects::body_drift(), {0.01, 0.02, 0}, {0, 0, 0}), {0.04, 0.08, 0});
  check_close(walked(effects::body_drift(), {0.01, 0.02, 0}, {0, 0, 0}, quarter), {-0.08, 0.04, quarter});
  check_close(walked(effects::body_drift(), {0, 0, 0.1}, {0, 0, 0}), {0, 0, 0.4});
}

TEST_CASE("sloping ground carries the same way whatever the heading") {
  for (const double heading : {0.0, quarter, 2.5}) {
    check_close(walked(effects::ground_slope(), {0.01, -0.02}, {0, 0, 0.3}, heading), {0.04, -0.08, heading + 1.2});
  }
}

TEST_CASE("ground may carry in proportion to the distance walked") {
  check_close(walked(effects::ground_slope_distance(), {0.1, -0.2}, {0, 0.5, 0}), {0.2, 2 - 0.4, 0});
  check_close(walked(effects::ground_slope_distance(), {0.1, -0.2}, {0, 0, 0.1}), {0, 0, 0.4});
}

TEST_CASE("cross coupling adds one part of a step to another") {
  const Pose2 step{1, 10, 100};
  const std::vector<double> p = {0.5};
  const auto coupled = [&](const Effect& effect) { return effect.planar(step, 0.3, p).vec(); };
  check_close(coupled(effects::cross_coupling_forward_to_turn()), {1, 10, 100.5});
  check_close(coupled(effects::cross_coupling_forward_to_lateral()), {1, 10.5, 100});
  check_close(coupled(effects::cross_coupling_lateral_to_turn()), {1, 10, 105});
  check_close(coupled(effects::cross_coupling_lateral_to_forward()), {6, 10, 100});
  check_close(coupled(effects::cross_coupling_turn_to_forward()), {51, 10, 100});
  check_close(coupled(effects::cross_coupling_turn_to_lateral()), {1, 60, 100});
}

TEST_CASE("the forms of cross coupling say what they couple") {
  for (const Effect& effect : planar_effects()) {
    if (effect.name != "cross_coupling") continue;
    const std::string from = effect.form.substr(0, effect.form.find('_'));
    CHECK(effect.sentence.starts_with(from + " motion"));
  }
}

TEST_CASE("effects on inputs reach the steps of a walk") {
  Recording recording;
  recording.name = "test";
  recording.time = Eigen::VectorXd::LinSpaced(5, 0, 4);
  recording.inputs = Eigen::MatrixXd::Zero(3, 5);
  recording.inputs.row(1) << 0.1, -0.1, 0.1, -0.1, 0;
  recording.outputs = Eigen::MatrixXd::Zero(3, 5);
  recording.initial = recording.initial_scale = Eigen::Vector3d::Zero();
  Augmented augmented;
  augmented.effects = {{.name = "input_asymmetry", .attached_to = "lateral", .values = {0.2}}};
  const Eigen::Vector3d end = simulate_augmented(Walk{}, augmented, recording).states.col(4);
  CHECK(end[1] == doctest::Approx(2 * 0.12 - 2 * 0.08));
}

}  // namespace
}  // namespace surefoot

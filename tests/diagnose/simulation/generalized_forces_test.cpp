// Forces that move several velocities at once: two links with dry friction in both joints, a crane.
#include "surefoot/diagnose/simulation/generalized_forces.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/two_links.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::blank_recording;
using toys::machine;
using two_links::LinkState, two_links::TwoLinks;

// The rods of the reference as a simulator, with a torque at each joint.
struct Arm {
  using State = Vec<4>;
  using Input = Vec<2>;
  using Output = Vec<2>;

  SimulatorInfo info() const {
    return {.name = "arm",
            .states = {{"q1", "rad"}, {"q2", "rad"}, {"v1", "rad/s", "N m"}, {"v2", "rad/s", "N m"}},
            .inputs = {{"torque_1", "N m"}, {"torque_2", "N m"}},
            .outputs = {{"q1", "rad"}, {"q2", "rad"}},
            .parameters = {{"upper", "kg", 1.5, 1, 3}}};
  }
  static LinkState at(const State& x) { return {{x[0], x[1]}, {x[2], x[3]}}; }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    const two_links::Pair a = TwoLinks{}.acceleration(at(x), {1, 1});  // without friction: it is 0
    return State(x[2], x[3], a[0], a[1]) + response(x, u, p, State(0, 0, u[0], u[1]));
  }
  State response(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/, const State& forces) const {
    const auto [a, b, c] = TwoLinks{}.mass({x[0], x[1]});
    const double determinant = a * c - b * b;
    return {0, 0, (c * forces[2] - b * forces[3]) / determinant, (a * forces[3] - b * forces[2]) / determinant};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x.head<2>(); }
};
static_assert(Simulator<Arm> && has_response<Arm>);

constexpr std::array<double, 2> friction{0.25, 0.12};  // [N m]

Augmented rubbing_arm(double step) {
  return machine({1.5},
                 {{.name = "coulomb_friction", .attached_to = "v1", .values = {friction[0]}},
                  {.name = "coulomb_friction", .attached_to = "v2", .values = {friction[1]}}},
                 {4, step});
}

Recording let_go(double seconds, double period) {
  const auto rows = static_cast<Eigen::Index>(std::lround(seconds / period)) + 1;
  Recording recording = blank_recording(Arm{}.info(), rows, period);
  recording.initial << 1.3, -0.8, 0, 0;
  return recording;
}

TEST_CASE("dry friction at two coupled joints follows an integration from event to event") {
  constexpr double period = 0.01;
  const Recording recording = let_go(5, period);
  const SimulatedRun run = simulate_augmented(Arm{}, rubbing_arm(1e-4), recording);
  TwoLinks links;
  links.friction = friction;
  LinkState state{{1.3, -0.8}, {0, 0}};
  std::array<int, 2> slides = links.choose(state);
  double farthest = 0;
  int changes = 0;
  for (Eigen::Index k = 1; k < recording.rows(); ++k) {
    for (int s = 0; s < 50; ++s) {
      const std::array<int, 2> before = slides;
      links.advance(state, slides, period / 50);
      changes += slides != before ? 1 : 0;
    }
    for (Eigen::Index i = 0; i < 2; ++i) {
      farthest = std::max(farthest, std::abs(run.outputs(i, k) - state.q[static_cast<std::size_t>(i)]));
    }
  }
  CHECK(changes > 10);
  CHECK(farthest < 1e-6);
}

TEST_CASE("a joint that sticks holds exactly while the other moves, and energy never grows") {
  const Recording recording = let_go(5, 0.001);
  const SimulatedRun run = simulate_augmented(Arm{}, rubbing_arm(0), recording);
  const TwoLinks links;
  int held = 0, alone = 0;
  double grown = 0;
  for (Eigen::Index k = 1; k < recording.rows(); ++k) {
    const Vec<4> before = run.states.col(k - 1), now = run.states.col(k);
    grown = std::max(grown, links.energy(Arm::at(now)) - links.energy(Arm::at(before)));
    for (Eigen::Index i = 0; i < 2; ++i) {
      if (before[2 + i] != 0 || now[2 + i] != 0) continue;
      ++held;
      alone += now[3 - i] != 0 ? 1 : 0;
      CHECK(now[i] == before[i]);
    }
  }
  CHECK(held > 500);
  CHECK(alone > 20);
  CHECK(grown < 1e-6);
  CHECK(links.energy(Arm::at(run.states.col(recording.rows() - 1))) < links.energy(Arm::at(run.states.col(0))) - 1);
}

TEST_CASE("a torque that friction of both joints can just hold moves nothing, a little more moves the arm") {
  Recording recording = blank_recording(Arm{}.info(), 100, 0.01);  // hangs at rest
  for (const double share : {0.99, 1.01}) {
    recording.inputs.row(0).setConstant(share * friction[0]);
    const SimulatedRun run = simulate_augmented(Arm{}, rubbing_arm(0), recording);
    const double moved = run.outputs.cwiseAbs().maxCoeff();
    CHECK((share < 1 ? moved == 0 : moved > 1e-4));
  }
}

TEST_CASE("the force behind the rates of coupled joints is that of the mass matrix") {
  const Arm arm;
  const Eigen::VectorXd p = Eigen::VectorXd::Constant(1, 1.5);
  Arm copy = arm;
  const SimulatorStructure structure = find_structure(arm, arm.info(), let_go(1, 0.1), let_go(1, 0.1), p);
  CHECK(structure.pushed == std::vector<int>{2, 3});
  const AugmentedSimulator<Arm> m{.simulator = copy, .structure = structure, .p = p, .slots = {}, .raw = {}};
  const Vec<4> x(0.4, 1.1, 0.3, -2);
  const auto response = force_response(m, x, Vec<2>(0, 0));
  const Vec<4> rates = arm.response(x, Vec<2>(0, 0), p, Vec<4>(0, 0, 0.7, -0.2));
  CHECK(force_on(m, response, 2, rates) == doctest::Approx(0.7));
  CHECK(force_on(m, response, 3, rates) == doctest::Approx(-0.2));
}

// An arm whose second force is squared, and one that a force moves backwards.
struct SquaringArm : Arm {
  State response(const State& x, const Input& u, const Eigen::VectorXd& p, const State& forces) const {
    return Arm::response(x, u, p, State(0, 0, forces[2], forces[3] * forces[3]));
  }
};
struct ContraryArm : Arm {
  State response(const State& x, const Input& u, const Eigen::VectorXd& p, const State& forces) const {
    return Arm::response(x, u, p, -forces);
  }
};

TEST_CASE("a response that is none of forces is refused with its velocity") {
  const Eigen::VectorXd p = Eigen::VectorXd::Constant(1, 1.5);
  CHECK_THROWS_WITH_AS(find_structure(SquaringArm{}, Arm{}.info(), let_go(1, 0.1), let_go(1, 0.1), p),
                       doctest::Contains("twice the force on v2"), DiagnoseError);
  CHECK_THROWS_WITH_AS(find_structure(ContraryArm{}, Arm{}.info(), let_go(1, 0.1), let_go(1, 0.1), p),
                       doctest::Contains("does not make v1 grow"), DiagnoseError);
}

TEST_CASE("a stop that one joint hits takes momentum of the other") {
  Recording recording = blank_recording(Arm{}.info(), 2, 1e-4);
  recording.initial << 0, 0.5 - 1e-6, 0, 1;
  Augmented arm = machine({1.5}, {{.name = "end_stop", .attached_to = "v2", .form = "upper", .values = {0.5, 0.0}}});
  const SimulatedRun run = simulate_augmented(Arm{}, arm, recording);
  const auto [a, b, c] = TwoLinks{}.mass({0, 0.5});
  CHECK(std::abs(run.states(3, 1)) < 0.01);  // gravity begins to pull it back
  CHECK(run.states(2, 1) == doctest::Approx(b / a).epsilon(1e-2));  // a v1 + b v2 does not change
  (void)c;
}

// The arm without a response: what the torque at one joint does to both is in its rates alone.
struct MuteArm : Arm {
  State response(const State& x, const Input& u, const Eigen::VectorXd& p, const State& forces) const = delete;
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const { return Arm{}.derivative(x, u, p); }
};

TEST_CASE("velocities that one input moves at once are noticed where nothing says what a force does") {
  const Eigen::VectorXd p = Eigen::VectorXd::Constant(1, 1.5);
  static_assert(!has_response<MuteArm>);
  CHECK(find_structure(MuteArm{}, Arm{}.info(), let_go(1, 0.1), let_go(1, 0.1), p).moved_together ==
        std::vector<int>{2, 3});
  CHECK(find_structure(Arm{}, Arm{}.info(), let_go(1, 0.1), let_go(1, 0.1), p).moved_together.empty());
  CHECK(moved_together_sentence(Arm{}.info(), {2, 3}).find("one input moves v1 and v2 at once") == 0);
}

// Recordings of the arm with friction in both joints, shaken by torques.
std::vector<Recording> shaken_arms() {
  Rng rng(3);
  std::vector<Recording> recordings;
  for (int r = 0; r < 4; ++r) {
    Recording recording = blank_recording(Arm{}.info(), 300, 0.01);
    recording.name = "shaken " + std::to_string(r);
    for (Eigen::Index k = 0; k < recording.rows(); ++k) {
      const double t = recording.time[k];
      recording.inputs.col(k) << 1.2 * std::sin((2 + r) * t), 0.4 * std::sin((5 - 0.7 * r) * t + 1);
    }
    recording.outputs = simulate_augmented(Arm{}, rubbing_arm(1e-3), recording).outputs;
    for (double& reading : recording.outputs.reshaped()) reading += 1e-3 * rng.normal();
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

TEST_CASE("a diagnosis finds dry friction in both joints of an arm, at its level") {
  const Diagnosis found = diagnose(
      Arm{}, shaken_arms(), {.effects = {"coulomb_friction", "viscous_friction", "constant_force"}}, Serial{}, 1);
  CAPTURE(found.sentence);
  CHECK(found.verdict == Verdict::missing_physics);
  REQUIRE(found.effects.size() == 2);
  for (const FoundEffect& effect : found.effects) {
    CHECK(effect.name == "coulomb_friction");
    CHECK(effect.parameters[0].value == doctest::Approx(friction[effect.attached_to == "v2" ? 1 : 0]).epsilon(0.02));
    CHECK(effect.parameters[0].unit == "N m");
  }
  CHECK(found.effects[0].attached_to != found.effects[1].attached_to);
}

}  // namespace
}  // namespace surefoot::diagnosis

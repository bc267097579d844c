// Two links with dry friction in both joints, against equations of motion that are integrated from event to event.
#include "apps/diagnose/robot/simulate_robot.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "apps/diagnose/robot/robot_step.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

namespace {

using Pair = std::array<double, 2>;

constexpr double gravity = 9.81, rotor = 0.01;  // [m/s^2], [kg m^2] as the file has it

struct State {
  Pair q{}, v{};
};

// Two rods that hang on each other, by Lagrange's equations; slides[i]: direction in which joint i slips, 0: it sticks.
struct TwoLinks {
  double l1 = 0.25, l2 = 0.25, m1 = 1.5, m2 = 0.8;
  Pair friction{};

  static double rod_inertia(double m, double l) { return m * (l * l / 12 + 0.0009); }

  std::array<double, 3> mass(const Pair& q) const {  // M11, M12, M22
    const double a = l2 / 2, c = l1 * a * std::cos(q[1]), i2 = rod_inertia(m2, l2);
    return {rod_inertia(m1, l1) + m1 * l1 * l1 / 4 + i2 + m2 * (l1 * l1 + a * a + 2 * c) + rotor, i2 + m2 * (a * a + c),
            i2 + m2 * a * a + rotor};
  }

  Pair pull(const State& s) const {  // of gravity and Coriolis forces
    const double a = l2 / 2, w = m2 * l1 * a * std::sin(s.q[1]), second = m2 * gravity * a * std::sin(s.q[0] + s.q[1]);
    return {w * (2 * s.v[0] * s.v[1] + s.v[1] * s.v[1]) - (m1 * l1 / 2 + m2 * l1) * gravity * std::sin(s.q[0]) - second,
            -w * s.v[0] * s.v[0] - second};
  }

  double energy(const State& s) const {
    const auto [a, b, c] = mass(s.q);
    return (a * s.v[0] * s.v[0] + 2 * b * s.v[0] * s.v[1] + c * s.v[1] * s.v[1]) / 2 -
           (m1 * l1 / 2 + m2 * l1) * gravity * std::cos(s.q[0]) - m2 * gravity * l2 / 2 * std::cos(s.q[0] + s.q[1]);
  }

  Pair acceleration(const State& s, const std::array<int, 2>& slides) const {
    const auto [a, b, c] = mass(s.q);
    Pair push = pull(s);
    for (std::size_t i = 0; i < 2; ++i) push[i] -= friction[i] * slides[i];
    if (slides[0] == 0 && slides[1] == 0) return {0, 0};
    if (slides[0] == 0) return {0, push[1] / c};
    if (slides[1] == 0) return {push[0] / a, 0};
    const double determinant = a * c - b * b;
    return {(c * push[0] - b * push[1]) / determinant, (a * push[1] - b * push[0]) / determinant};
  }

  // Torque that a sticking joint has to hold.
  Pair held(const State& s, const std::array<int, 2>& slides) const {
    const auto [a, b, c] = mass(s.q);
    const Pair at = acceleration(s, slides), push = pull(s);
    return {push[0] - a * at[0] - b * at[1], push[1] - b * at[0] - c * at[1]};
  }

  // Of joints that stand still, what they do next: the only choice that contradicts nothing.
  std::array<int, 2> choose(const State& s) const {
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const std::array<int, 2> slides{s.v[0] != 0 ? (s.v[0] > 0 ? 1 : -1) : i,
                                        s.v[1] != 0 ? (s.v[1] > 0 ? 1 : -1) : j};
        const Pair at = acceleration(s, slides), torque = held(s, slides);
        bool good = true;
        for (std::size_t k = 0; k < 2; ++k) {
          if (s.v[k] != 0) continue;
          good = good && (slides[k] == 0 ? std::abs(torque[k]) <= friction[k] : at[k] * slides[k] > 0);
        }
        if (good) return slides;
      }
    }
    return {0, 0};
  }

  State runge_kutta(const State& s, const std::array<int, 2>& slides, double h) const {
    const auto moved = [&](const Pair& v, const Pair& a, double t) {
      State next = s;
      for (std::size_t i = 0; i < 2; ++i) {
        next.q[i] += t * v[i];
        next.v[i] += t * a[i];
      }
      return next;
    };
    const Pair a1 = acceleration(s, slides);
    const State s2 = moved(s.v, a1, h / 2);
    const Pair a2 = acceleration(s2, slides);
    const State s3 = moved(s2.v, a2, h / 2);
    const Pair a3 = acceleration(s3, slides);
    const State s4 = moved(s3.v, a3, h);
    const Pair a4 = acceleration(s4, slides);
    State next = s;
    for (std::size_t i = 0; i < 2; ++i) {
      next.q[i] += h / 6 * (s.v[i] + 2 * s2.v[i] + 2 * s3.v[i] + s4.v[i]);
      next.v[i] += h / 6 * (a1[i] + 2 * a2[i] + 2 * a3[i] + a4[i]);
    }
    return next;
  }

  bool is_valid(const State& s, const std::array<int, 2>& slides) const {
    const Pair torque = held(s, slides);
    for (std::size_t i = 0; i < 2; ++i) {
      if (slides[i] == 0 ? std::abs(torque[i]) > friction[i] : s.v[i] * slides[i] < 0) return false;
    }
    return true;
  }

  // By steps that end where a joint comes to rest or breaks away.
  void advance(State& s, std::array<int, 2>& slides, double length) const {
    double left = length;
    while (left > 0) {
      State next = runge_kutta(s, slides, left);
      if (is_valid(next, slides)) {
        s = next;
        return;
      }
      double low = 0, high = left;
      for (int halving = 0; halving < 60; ++halving) {
        const double middle = (low + high) / 2;
        (is_valid(runge_kutta(s, slides, middle), slides) ? low : high) = middle;
      }
      next = runge_kutta(s, slides, high);
      for (std::size_t i = 0; i < 2; ++i) {
        if (slides[i] == 0 || next.v[i] * slides[i] <= 0) next.v[i] = 0;
      }
      s = next;
      slides = choose(s);
      left -= high;
    }
  }
};

// The arm of the tests without its drives, let go.
struct LetGo {
  ScratchFolder folder;
  Robot robot;
  RobotRecording recording;
  RobotPhysics physics;
  StartState start;
  static constexpr double seconds = 5, period = 0.01;

  explicit LetGo(const TwoLinks& links, double step) {
    const auto arm = robot_test::small_arm();
    robot_test::write_files(folder, arm, 31, 1);
    robot = robot_test::load(folder);
    robot.setup.step = step;
    for (RobotJoint& joint : robot.joints) joint.setup.kp = joint.setup.kd = joint.setup.limit = 0;
    physics = robot.nominal;
    for (std::size_t i = 0; i < 2; ++i) physics[i][Property::coulomb] = links.friction[i];
    const auto rows = static_cast<Eigen::Index>(std::lround(seconds / period)) + 1;
    recording.time = Eigen::VectorXd::LinSpaced(rows, 0, seconds);
    recording.angle.setZero(rows, 2);
    recording.goal.setZero(rows, 2);
    start = {Eigen::Vector2d(1.3, -0.8), Eigen::Vector2d::Zero()};
  }
};

TwoLinks with_friction() {
  TwoLinks links;
  links.friction = {0.25, 0.12};
  return links;
}

}  // namespace

TEST_CASE("two links with dry friction in both joints move as a fine integration from event to event says") {
  const TwoLinks links = with_friction();
  const LetGo arm(links, 1e-4);
  const Eigen::MatrixXd readings = simulate_robot(arm.robot, arm.recording, arm.start, arm.physics);
  State state{{arm.start.angle[0], arm.start.angle[1]}, {0, 0}};
  std::array<int, 2> slides = links.choose(state);
  double farthest = 0;
  int rests = 0;
  for (Eigen::Index k = 1; k < readings.rows(); ++k) {
    for (int s = 0; s < 50; ++s) {
      const std::array<int, 2> before = slides;
      links.advance(state, slides, LetGo::period / 50);
      rests += slides[0] != before[0] || slides[1] != before[1] ? 1 : 0;
    }
    for (Eigen::Index i = 0; i < 2; ++i)
      farthest = std::max(farthest, std::abs(readings(k, i) - state.q[static_cast<std::size_t>(i)]));
  }
  CHECK(rests > 10);
  CHECK(farthest < 1e-6);
}

TEST_CASE("a joint that friction holds does not move at all, and without a drive energy never grows") {
  const TwoLinks links = with_friction();
  const LetGo arm(links, 0.001);
  RobotStep step(arm.robot, arm.recording, arm.start, arm.physics);
  const auto energy = [&] { return links.energy({{step.q[0], step.q[1]}, {step.v[0], step.v[1]}}); };
  const double lowest = links.energy({});
  double before = energy();
  const double all = before - lowest;
  double grown = 0;
  int held = 0;
  for (int k = 0; k < 5000; ++k) {
    const Eigen::VectorXd angle = step.q, was = step.v;
    step.step(std::min<Eigen::Index>(k / 10, arm.recording.time.size() - 1), k * 1e-3, 1e-3);
    for (Eigen::Index i = 0; i < 2; ++i) {
      if (step.v[i] != 0 || was[i] != 0) continue;
      ++held;
      CHECK(step.q[i] == angle[i]);
    }
    grown = std::max(grown, energy() - before);
    before = energy();
  }
  CHECK(held > 500);
  CHECK(grown < 1e-6 * all);  // what steps of 1 ms make of a motion that loses nothing
  CHECK(before < links.energy({{1.3, -0.8}, {0, 0}}));
}

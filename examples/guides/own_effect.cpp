// An effect of your own, found in recordings: a motor that turns an arm, and a cable that pulls once the arm has taken
// up its slack. Exits with 1 unless the diagnosis names the cable, and its numbers are those of the machine.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "surefoot/diagnose.hpp"

using namespace surefoot;

// [effect]
// Force -stiffness (q - slack) on the speed of q, where q is beyond the slack.
Effect cable() {
  return {
      .name = "cable",
      .sentence = "a cable of {stiffness} that pulls beyond {slack} at {at}",
      .place = Place::velocity,
      .parameters = {{.name = "stiffness",
                      .measure = {.effort = 1, .position = -1},  // its unit: that of the force per angle
                      .low = 0,
                      .high = 20,
                      .starts = {0.01, 0.3},
                      .strength = true},  // without it there is no cable
                     {.name = "slack", .measure = {.position = 1}, .low = -3, .high = 3, .starts = {-0.5, 0, 0.5, 1}}},
      .confusable_with = {"cubic_stiffness", "end_stop"},
      .experiment = "slow swings to either side, some short of the cable and some well into it",
      .force = [](const EffectContext& m, Values p, Values) { return -p[0] * std::max(0.0, m.position - p[1]); }};
}
// [effect]

// [simulator]
struct Arm {
  using State = Vec<2>;   // angle [rad], speed [rad/s]
  using Input = Vec<1>;   // torque [N m]
  using Output = Vec<1>;  // angle [rad]

  SimulatorInfo info() const {
    return {.name = "arm",
            .states = {{"q", "rad"}, {"speed", "rad/s", "N m"}},  // effects on the speed are torques
            .inputs = {{"torque", "N m"}},
            .outputs = {{"q_rad", "rad"}},
            .parameters = {{"inertia", "kg m^2", 0.02, 0.005, 0.1}, {"damping", "N m s/rad", 0.02, 0, 0.2}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], (u[0] - p[1] * x[1]) / p[0]};
  }
  State effort(const State&, const Input&, const Eigen::VectorXd& p) const { return {1, p[0]}; }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }
};
static_assert(Simulator<Arm>);
// [simulator]

namespace {

constexpr double stiffness = 0.4, slack = 0.3;  // of the real cable [N m/rad], [rad]

// The real machine: its own equations in small steps, 100 rows a second, noise of 1 mrad.
Recording record(int number, Rng rng) {
  constexpr Eigen::Index rows = 400;
  Recording recording;
  recording.name = "swing " + std::to_string(number);
  recording.time = Eigen::VectorXd::LinSpaced(rows, 0, 3.99);
  recording.inputs.resize(1, rows);
  recording.outputs.resize(1, rows);
  recording.initial = recording.initial_scale = Vec<2>::Zero();
  const double pace = rng.uniform(1.5, 4), size = rng.uniform(0.06, 0.15);
  double q = 0, speed = 0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double torque = size * std::sin(pace * recording.time[i]);
    recording.inputs(0, i) = torque;
    recording.outputs(0, i) = q + 0.001 * rng.normal();
    for (int step = 0; step < 20; ++step) {
      const double pull = stiffness * std::max(0.0, q - slack);
      speed += 0.0005 * (torque - 0.05 * speed - pull) / 0.03;
      q += 0.0005 * speed;
    }
  }
  return recording;
}

}  // namespace

int main() {
  std::vector<Recording> recordings;
  for (int i = 0; i < 8; ++i) recordings.push_back(record(i, Rng(1, static_cast<std::uint64_t>(i))));

  // [diagnose]
  DiagnoseOptions options;
  options.more_effects = {cable()};  // considered beside the library's own
  const Diagnosis diagnosis = diagnose(Arm{}, recordings, options, Threads{}, /*seed*/ 1);
  std::printf("%s\n", diagnosis.sentence.c_str());
  for (const FoundEffect& effect : diagnosis.effects) {
    for (const FittedValue& value : effect.parameters) {
      std::printf("  %s: %.3f (%.3f to %.3f) %s\n", value.name.c_str(), value.value, value.low, value.high,
                  value.unit.c_str());
    }
  }
  // [diagnose]

  if (diagnosis.verdict != Verdict::missing_physics || diagnosis.effects.size() != 1) return 1;
  const FoundEffect& found = diagnosis.effects.front();
  return found.name == "cable" && std::abs(found.parameters[0].value - stiffness) < 0.05 * stiffness &&
                 std::abs(found.parameters[1].value - slack) < 0.02
             ? 0
             : 1;
}

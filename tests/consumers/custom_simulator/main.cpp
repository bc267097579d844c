// A simulator of one's own, a driven cart on a rail, and an effect of one's own: a magnet beside the rail that attracts
// the cart. The machine has such a magnet, the simulator does not. Fails unless the diagnosis names it and its
// strength.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnose.hpp"

double pull(double position, double strength, double place) {  // of the magnet [N], [m]
  const double off = (position - place) / 0.1;
  return -strength * off * std::exp(-off * off);
}

struct Cart {
  using State = surefoot::Vec<2>;
  using Input = surefoot::Vec<1>;
  using Output = surefoot::Vec<1>;
  surefoot::SimulatorInfo info() const {
    return {.name = "cart",
            .states = {{"position", "m"}, {"speed", "m/s", "N"}},
            .inputs = {{"force", "N"}},
            .outputs = {{"position", "m"}},
            .parameters = {{"mass", "kg", 1.0, 0.3, 3.0}, {"spring", "N/m", 5.0, 1.0, 20.0}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], (u[0] - p[1] * x[0] - 0.8 * x[1]) / p[0]};
  }
  State effort(const State&, const Input&, const Eigen::VectorXd& p) const { return {1, p[0]}; }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }
};
static_assert(surefoot::Simulator<Cart>);

surefoot::Effect magnet() {
  return {.name = "magnet",
          .sentence = "a magnet beside the rail that pulls with {strength}, at {at}",
          .place = surefoot::Place::velocity,
          .parameters = {{"strength", {.effort = 1}, 0, 20, {0.1, 0.5}, true},
                         {"place", {.position = 1}, -3, 3, {-1, 0, 1}}},
          .force = [](const surefoot::EffectContext& m, surefoot::Values p, surefoot::Values) {
            return pull(m.position, p[0], p[1]);
          }};
}

surefoot::Recording recording_of_the_machine(int number) {  // mass 1.1, spring 5, a magnet of 1.5 N at 0.15 m
  surefoot::Rng rng(7, static_cast<std::uint64_t>(number));
  surefoot::Recording result;
  result.name = "run " + std::to_string(number);
  constexpr int rows = 400;
  result.time = Eigen::VectorXd::LinSpaced(rows, 0, 0.01 * (rows - 1));
  result.inputs.resize(1, rows);
  result.outputs.resize(1, rows);
  result.initial = result.initial_scale = surefoot::Vec<2>::Zero();
  double position = 0, speed = 0;
  const double amplitude = 1 + 0.3 * number, frequency = 2 + 0.35 * number;
  for (int i = 0; i < rows; ++i) {
    result.inputs(0, i) = amplitude * std::sin(frequency * result.time[i]);
    result.outputs(0, i) = position + 0.0005 * rng.normal();
    for (int k = 0; k < 100; ++k) {
      speed += 1e-4 / 1.1 * (result.inputs(0, i) - 5 * position - 0.8 * speed + pull(position, 1.5, 0.15));
      position += 1e-4 * speed;
    }
  }
  return result;
}

int main() {
  std::vector<surefoot::Recording> recordings;
  for (int i = 0; i < 8; ++i) recordings.push_back(recording_of_the_machine(i));
  const auto found =
      surefoot::diagnose(Cart{}, recordings, {.more_effects = {magnet()}}, surefoot::Threads{}, /*seed*/ 1);
  std::printf("%s\n", found.sentence.c_str());
  for (const auto& effect : found.effects)
    for (const auto& value : effect.parameters)
      std::printf("%s: %s = %.3g %s\n", effect.name.c_str(), value.name.c_str(), value.value, value.unit.c_str());
  if (found.effects.size() != 1 || found.effects[0].name != "magnet") return 1;
  return std::abs(found.effects[0].parameters[0].value - 1.5) < 0.15 ? 0 : 1;
}

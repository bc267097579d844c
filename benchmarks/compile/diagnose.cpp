// A user of the diagnosis: a pendulum whose simulator may lack something that recordings show.
#include "surefoot/diagnose.hpp"

#include <cmath>
#include <cstdio>
#include <vector>

struct Pendulum {
  using State = surefoot::Vec<2>;   // angle [rad], speed [rad/s]
  using Input = surefoot::Vec<1>;   // torque [N m]
  using Output = surefoot::Vec<1>;  // measured angle [rad]
  surefoot::SimulatorInfo info() const {
    return {.name = "pendulum",
            .states = {{"theta", "rad"}, {"omega", "rad/s", "N m"}},
            .inputs = {{"torque", "N m"}},
            .outputs = {{"theta", "rad"}},
            .parameters = {{"inertia", "kg m^2", 0.02, 0.005, 0.1}, {"damping", "N m s/rad", 0.02, 0.0, 0.2}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], (u[0] - p[1] * x[1] - 0.5 * std::sin(x[0])) / p[0]};
  }
  State effort(const State&, const Input&, const Eigen::VectorXd& p) const { return {1, p[0]}; }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }
};
static_assert(surefoot::Simulator<Pendulum>);

int main() {
  const surefoot::Augmented machine{
      .effects = {{.name = "coulomb_friction", .attached_to = "omega", .values = {0.05}}}};
  std::vector<surefoot::Recording> recordings;
  for (std::uint64_t r = 0; r < 4; ++r) {
    surefoot::Recording recording;
    recording.name = "recording " + std::to_string(r);
    recording.time.setLinSpaced(300, 0, 2.99);
    recording.inputs = 0.4 * (2 * recording.time.array() + static_cast<double>(r)).sin().matrix().transpose();
    recording.outputs.setZero(1, 300);
    recording.initial = recording.initial_scale = Eigen::Vector2d::Zero();
    recording.outputs = simulate_augmented(Pendulum{}, machine, recording).outputs;
    surefoot::Rng rng(1, r);
    for (double& value : recording.outputs.reshaped()) value += 0.001 * rng.normal();
    recordings.push_back(recording);
  }
  const auto diagnosis = surefoot::diagnose(Pendulum{}, recordings, {}, surefoot::Threads{}, /*seed*/ 1);
  std::printf("%s\n", diagnosis.sentence.c_str());
}

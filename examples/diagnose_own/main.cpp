// A simulator in C++ with the command line of surefoot-diagnose: a servo that swings a weight.
// Columns of the recordings: t_s, goal_rad, theta_rad, and `# mass_kg: 0.49` and the like in the first lines.
#include <algorithm>
#include <cmath>

#include "surefoot/core/vec.hpp"
#include "surefoot_apps/diagnose_main.hpp"

struct ServoPendulum {
  using State = surefoot::Vec<2>;  // angle [rad], 0 hanging down, and speed [rad/s]
  using Input = surefoot::Vec<1>;  // commanded angle [rad]
  using Output = surefoot::Vec<1>;
  double mass = 0, length = 0, gain = 0, supply = 0;  // [kg], [m], [1/rad], [V]: of each recording

  surefoot::SimulatorInfo info() const {
    return {
        .name = "servo pendulum",
        .states = {{"theta", "rad"}, {"omega", "rad/s", "N m"}},
        .inputs = {{"goal", "rad"}},
        .outputs = {{"theta", "rad"}},
        .parameters = {
            {"kt", "N m/A", 1.6, 0.3, 5.0}, {"R", "ohm", 3.6, 0.5, 15.0}, {"armature", "kg m^2", 0.012, 0.0005, 0.1}}};
  }

  ServoPendulum for_recording(const surefoot::Recording& recording) const {
    return {constant_of(recording, "mass_kg"), constant_of(recording, "length_m"), constant_of(recording, "kp"),
            constant_of(recording, "vin_V")};
  }

  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    const double duty = std::clamp(gain * (u[0] - x[0]), -1.0, 1.0);
    const double torque = p[0] / p[1] * (supply * duty - p[0] * x[1]);
    return {x[1], (torque - mass * 9.81 * length * std::sin(x[0])) / inertia(p)};
  }
  State effort(const State&, const Input&, const Eigen::VectorXd& p) const { return {1, inertia(p)}; }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }
  double inertia(const Eigen::VectorXd& p) const { return p[2] + mass * length * length; }
};
static_assert(surefoot::Simulator<ServoPendulum>);

int main(int argc, char** argv) { return surefoot_diagnose_main(argc, argv, ServoPendulum{}); }

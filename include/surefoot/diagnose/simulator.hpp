// Concept of a simulator that can be diagnosed: any plain struct with equations of motion.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "surefoot/diagnose/recording.hpp"

namespace surefoot {

/// ode: rates, integrated between the rows of a recording. map: next values, one row is one step.
enum class SimulatorKind : std::uint8_t { ode, map };

struct StateInfo {
  std::string name, unit;
  std::string effort_unit = {};  // of rate times Simulator::effort, say "N m"; empty: effects act on the rate itself
};

struct InputInfo {
  std::string name, unit;
  std::optional<InputHold> hold = {};  // not given: held, unless a diagnosis finds that recordings say otherwise
};

struct OutputInfo {
  std::string name, unit;
  double noise = std::numeric_limits<double>::quiet_NaN();  // standard deviation, NaN: to be estimated
  /// Of a map: standard deviation by which chance makes it miss the next row from the readings of a row; NaN: unknown.
  double process_noise = std::numeric_limits<double>::quiet_NaN();
};

struct ParameterInfo {
  std::string name, unit;
  double value = 0, low = 0, high = 0;  // nominal value and bounds
  bool fixed = false;                   // true: never calibrated
};

/// Which states of a map are a pose in the plane; lets the walking effects attach.
struct PlanarInfo {
  int x = 0, y = 1, heading = 2;  // states [m, m, rad]
};

/// Everything about a simulator but its equations.
struct SimulatorInfo {
  std::string name;
  SimulatorKind kind = SimulatorKind::ode;
  std::vector<StateInfo> states;
  std::vector<InputInfo> inputs;
  std::vector<OutputInfo> outputs;
  std::vector<ParameterInfo> parameters;
  std::vector<std::string> signals = {};  // quantities inside the equations that effects may change (see tap)
  std::optional<PlanarInfo> planar = {};
};

/// How an ODE is integrated.
struct Integration {
  int order = 4;      // 4, or 2
  double step = 0;    // longest step [s]; 0: one step per row
  int restart = 0;    // begin again from the measured state every so many rows; 0: never (all states must be measured)
  double follow = 0;  // share of their distance to the readings by which measured states move in each row; 0: never
  std::vector<InputHold> inputs = {};  // between rows, where the model does not say; empty: all held
};

/// What input i is between rows: as the model says, else as was found (empty: held). What it says to go straight may
/// have been found to be band-limited.
inline InputHold hold_of(const SimulatorInfo& info, const std::vector<InputHold>& found, std::size_t i) {
  const std::optional<InputHold> said = info.inputs[i].hold;
  const InputHold shown = i < found.size() ? found[i] : InputHold::zero_order;
  const bool smoother = said == InputHold::linear && shown == InputHold::band_limited;
  return smoother ? shown : said.value_or(shown);
}

/// A simulated recording; states are those before each restart.
struct SimulatedRun {
  Eigen::MatrixXd outputs;  // output x row
  Eigen::MatrixXd states;   // state x row
  bool finite = true;
};

/// Lets effects reach quantities inside the equations: called as tap(i, value) for signal i, gives the value to use.
struct NoTap {
  double operator()(int /*signal*/, double value) const { return value; }
};

/// A simulator has equations `derivative` (ode, per second) or `next` (map), and `observe`, all functions of state,
/// input and parameters p (in the order of info().parameters). State, Input and Output are Eigen column vectors. The
/// smallest conforming struct:
///
///   struct Pendulum {
///     using State = surefoot::Vec<2>;
///     using Input = surefoot::Vec<1>;
///     using Output = surefoot::Vec<1>;
///     surefoot::SimulatorInfo info() const {
///       return {.name = "pendulum", .states = {{"theta", "rad"}, {"omega", "rad/s"}}, .inputs = {{"torque", "N m"}},
///               .outputs = {{"theta_rad", "rad"}}, .parameters = {{"inertia", "kg m^2", 0.01, 0.001, 0.1}}};
///     }
///     State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
///       return {x[1], (u[0] - std::sin(x[0])) / p[0]};
///     }
///     Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }
///   };
///
/// Optional: `State effort(x, u, p)`, what turns each rate into a force or torque (an inertia), 1 without it;
/// `State response(x, u, p, forces)`, where a force moves several velocities: what generalized forces on the states add
/// to the rates of all, M^-1 forces with the mass matrix M (0 for states that only have an effort);
/// `S for_recording(const Recording&)`, the simulator with the constants of that recording;
/// `void prepare(p)`, called before a run with these parameters;
/// `derivative(x, u, p, tap)` or `next(x, u, p, tap)`, which pass quantities inside through tap(i, value), named in
/// info().signals.
template <class S>
concept Simulator = std::copyable<S> &&
    requires(const S& simulator, const typename S::State& x, const typename S::Input& u, const Eigen::VectorXd& p) {
  { simulator.info() } -> std::convertible_to<SimulatorInfo>;
  { simulator.observe(x, u, p) } -> std::convertible_to<typename S::Output>;
  requires requires {
    { simulator.derivative(x, u, p) } -> std::convertible_to<typename S::State>;
  } || requires {
    { simulator.next(x, u, p) } -> std::convertible_to<typename S::State>;
  };
};

namespace detail {

template <class V>
concept ColumnVector = requires {
  requires V::ColsAtCompileTime == 1;
};

}  // namespace detail

/// One sentence about what S lacks to be a Simulator, the first thing in the order of the comment above; empty if it is
/// one. For static_assert, and for people.
template <class S>
constexpr std::string_view explain_simulator() {
  if constexpr (!std::copyable<S>) {
    return "a simulator must be a value that can be copied: each recording and each thread gets one of its own";
  } else if constexpr (!requires { typename S::State; }) {
    return "the simulator needs `using State = surefoot::Vec<n>;`, n the number of its states";
  } else if constexpr (!requires { typename S::Input; }) {
    return "the simulator needs `using Input = surefoot::Vec<n>;`, n the number of its inputs";
  } else if constexpr (!requires { typename S::Output; }) {
    return "the simulator needs `using Output = surefoot::Vec<n>;`, n the number of its outputs";
  } else if constexpr (!detail::ColumnVector<typename S::State> || !detail::ColumnVector<typename S::Input> ||
                       !detail::ColumnVector<typename S::Output>) {
    return "State, Input and Output of a simulator must be column vectors of Eigen, such as surefoot::Vec<2>";
  } else if constexpr (!requires(const S& s) {
                         { s.info() } -> std::convertible_to<SimulatorInfo>;
                       }) {
    return "the simulator needs `SimulatorInfo info() const`: its names, units, nominal values and bounds";
  } else if constexpr (!requires(const S& s, const typename S::State& x, const typename S::Input& u,
                                 const Eigen::VectorXd& p) {
                         { s.observe(x, u, p) } -> std::convertible_to<typename S::Output>;
                       }) {
    return "the simulator needs `Output observe(const State& x, const Input& u, const Eigen::VectorXd& p) const`";
  } else if constexpr (!Simulator<S>) {
    return "the simulator needs its equations, `State derivative(const State& x, const Input& u, const "
           "Eigen::VectorXd& p) const` (per second) or `State next(...) const` (one row to the next)";
  } else {
    return "";
  }
}

}  // namespace surefoot

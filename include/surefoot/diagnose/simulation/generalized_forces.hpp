// Generalized forces: what a force on one velocity does to the rates of all states, by the mass matrix of the simulator
// (its `response`), or, in a simulator without one, by the effort of that velocity alone.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/simulation/augmented_simulator.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// What forces on the states do to the rates of all, at a point.
template <Simulator S>
struct ForceResponse {
  typename S::State effort;                  // by state: of its rate alone, if nothing else holds it
  std::vector<typename S::State> by_pushed;  // by state of structure.pushed: rates per unit of force on it
};

/// Number of a state among those that forces push by way of the mass matrix; -1 for all others.
inline int number_of_pushed(const SimulatorStructure& structure, int state) {
  for (std::size_t k = 0; k < structure.pushed.size(); ++k) {
    if (structure.pushed[k] == state) return static_cast<int>(k);
  }
  return -1;
}

template <Simulator S>
ForceResponse<S> force_response(const AugmentedSimulator<S>& m, const typename S::State& x,
                                const typename S::Input& u) {
  ForceResponse<S> result{effort(m, x, u), {}};
  if constexpr (has_response<S>) {
    const std::vector<int>& pushed = m.structure.pushed;
    if constexpr (requires { m.simulator.unit_responses(x, u, pushed); }) {  // all by one evaluation
      if (!pushed.empty()) result.by_pushed = m.simulator.unit_responses(x, u, pushed);
    } else {
      for (const int state : pushed) {
        auto unit = unset<typename S::State>(x.size());
        set_each(unit, [state](Eigen::Index i) { return i == state ? 1.0 : 0.0; });
        result.by_pushed.push_back(m.simulator.response(x, u, m.p, unit));
      }
    }
    for (std::size_t k = 0; k < pushed.size(); ++k) result.effort[pushed[k]] = 1 / result.by_pushed[k][pushed[k]];
  }
  return result;
}

/// Adds to the rates what a force on a velocity does.
template <Simulator S>
void push(const AugmentedSimulator<S>& m, const ForceResponse<S>& response, int at, double force,
          typename S::State& rate) {
  const int number = number_of_pushed(m.structure, at);
  if (number < 0) {
    add_at(rate, at, force * (1 / response.effort[at]));
    return;
  }
  const auto& per_force = response.by_pushed[static_cast<std::size_t>(number)];
  for (Eigen::Index i = 0; i < rate.size(); ++i) rate[i] += force * per_force[i];
}

/// What each unit of force on one of these velocities, all pushed, adds to the rates of all of them: symmetric, since
/// it is the inverse of a mass matrix.
template <Simulator S>
Eigen::MatrixXd responses_among(const AugmentedSimulator<S>& m, const ForceResponse<S>& response,
                                const std::vector<int>& velocities) {
  const auto n = static_cast<Eigen::Index>(velocities.size());
  Eigen::MatrixXd among(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto number =
        static_cast<std::size_t>(number_of_pushed(m.structure, velocities[static_cast<std::size_t>(j)]));
    for (Eigen::Index i = 0; i < n; ++i) {
      among(i, j) = response.by_pushed[number][velocities[static_cast<std::size_t>(i)]];
    }
  }
  return among;
}

/// The forces on these velocities, all pushed, that make these rates of them.
template <Simulator S>
Eigen::VectorXd forces_for(const AugmentedSimulator<S>& m, const ForceResponse<S>& response,
                           const std::vector<int>& velocities, const typename S::State& rates) {
  Eigen::VectorXd wanted(static_cast<Eigen::Index>(velocities.size()));
  for (Eigen::Index i = 0; i < wanted.size(); ++i) wanted[i] = rates[velocities[static_cast<std::size_t>(i)]];
  return surefoot::detail::solve_symmetric(responses_among(m, response, velocities), wanted);
}

/// The generalized force on a state that goes with these rates.
template <Simulator S>
double force_on(const AugmentedSimulator<S>& m, const ForceResponse<S>& response, int at,
                const typename S::State& rates) {
  const int number = number_of_pushed(m.structure, at);
  if (number < 0) return response.effort[at] * rates[at];
  return forces_for(m, response, m.structure.pushed, rates)[number];
}

/// Holds velocities that dry friction keeps at rest.
template <Simulator S>
void hold(const AugmentedSimulator<S>& m, const ForceResponse<S>& response, const std::vector<int>& velocities,
          typename S::State& rate) {
  std::vector<int> pushed;
  for (const int at : velocities) {
    if (number_of_pushed(m.structure, at) >= 0) pushed.push_back(at);
  }
  if (!pushed.empty()) {
    const Eigen::VectorXd forces = forces_for(m, response, pushed, rate);
    for (std::size_t k = 0; k < pushed.size(); ++k) {
      push(m, response, pushed[k], -forces[static_cast<Eigen::Index>(k)], rate);
    }
  }
  for (const int at : velocities) rate[at] = 0;
}

}  // namespace surefoot::diagnosis

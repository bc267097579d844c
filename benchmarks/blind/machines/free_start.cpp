#include "free_start.hpp"

#include <algorithm>
#include <cmath>

#include "../plants/calibrate.hpp"
#include "laws.hpp"

namespace machines {
namespace {

constexpr int iterations = 6;           // nearly linear: a state's start shows in the readings as it fades
constexpr int dampings = 2;             // of a step that leads astray, as where friction holds
constexpr double damping_factor = 30;   // from one to the next
constexpr double first_damping = 1e-3;  // of the diagonal, over the factor
constexpr double settled = 1e-3;        // of the squares: what a step must promise to take away
constexpr double difference = 1e-3;    // of a start's size, for derivatives
constexpr double regularized = 1e-10;  // share of the diagonal, for starts that no reading shows

std::vector<std::size_t> free_states(const Machine& machine) {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < machine.states.size(); ++i)
    if (machine.states[i].initial == "free") free.push_back(i);
  return free;
}

// How far a state may be from where it begins: as far as its readings go, else its own size.
double size_of(const Machine& machine, const Recording& recording, std::size_t state) {
  double low = 0, high = 0;
  for (std::size_t k = 0; k < machine.outputs.size(); ++k) {
    if (machine.outputs[k].state != static_cast<int>(state)) continue;
    for (const double value : recording.readings[k])
      if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  }
  const double size = std::max(high - low, std::abs(recording.initial[state]));
  return size > 0 ? size : 1;
}

Column weighted(const Recording& recording, const plants::Series& series, const std::vector<double>& noise) {
  Column residuals;
  for (std::size_t k = 0; k < series.outputs.size(); ++k)
    for (std::size_t row = 0; row < series.outputs[k].size(); ++row) {
      const double reading = recording.readings[k][row];
      if (std::isfinite(reading) && !recording.outliers[k][row])
        residuals.push_back((reading - series.outputs[k][row]) / noise[k]);
    }
  return residuals;
}

double product(const Column& a, const Column& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

plants::Series simulate_as_user(const CompiledMachine& machine, const Values& parameters,
                                const std::vector<Hidden>& hidden, const Recording& recording, const plants::How& how,
                                const std::vector<double>& noise) {
  plants::Series best = simulate(machine, parameters, hidden, recording, how);
  const std::vector<std::size_t> free = free_states(machine.machine);
  if (!how.fit_free || free.empty()) return best;
  const bool steps = std::ranges::any_of(hidden, [](const Hidden& one) { return rounds(one.law); });
  Recording started = recording;
  Column residual = weighted(recording, best, noise);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    std::vector<Column> slopes;
    Values sizes;
    plants::How smooth = how;
    smooth.unrounded = true;
    const Column before_rounding =
        steps ? weighted(recording, simulate(machine, parameters, hidden, started, smooth), noise) : residual;
    for (const std::size_t state : free) {
      sizes.push_back(size_of(machine.machine, recording, state));
      Recording moved = started;
      moved.initial[state] += difference * sizes.back();
      Column slope = weighted(recording, simulate(machine, parameters, hidden, moved, smooth), noise);
      for (std::size_t i = 0; i < slope.size(); ++i) slope[i] = (slope[i] - before_rounding[i]) / difference;
      slopes.push_back(std::move(slope));
    }
    std::vector<Values> normal(free.size(), Values(free.size()));
    Values gradient(free.size());
    double largest = 0;
    for (std::size_t i = 0; i < free.size(); ++i) {
      for (std::size_t j = 0; j < free.size(); ++j) normal[i][j] = product(slopes[i], slopes[j]);
      gradient[i] = -product(slopes[i], residual);
      largest = std::max(largest, normal[i][i]);
    }
    const double before = product(residual, residual);
    double damping = 0;
    bool better = false;
    for (int k = 0; k <= dampings && !better; ++k) {
      std::vector<Values> damped = normal;
      for (std::size_t i = 0; i < free.size(); ++i) damped[i][i] += regularized * largest + damping * normal[i][i];
      const Values step = plants::solve(damped, gradient);
      if (!(product(step, gradient) > settled * before)) break;  // all that it promises
      Recording tried = started;
      for (std::size_t i = 0; i < free.size(); ++i) tried.initial[free[i]] += step[i] * sizes[i];
      plants::Series series = simulate(machine, parameters, hidden, tried, how);
      Column now = weighted(recording, series, noise);
      damping = std::max(damping, first_damping) * damping_factor;
      if (!(product(now, now) < before)) continue;
      better = true;
      started = std::move(tried), best = std::move(series), residual = std::move(now);
    }
    if (!better) break;
  }
  return best;
}

}  // namespace machines

#include "calibrate.hpp"

#include <algorithm>
#include <cmath>

#include "systems.hpp"

namespace plants {
namespace {

double cost(const Column& values) {
  double sum = 0;
  for (double value : values) sum += std::isfinite(value) ? value * value : 1e12;
  return sum;
}

struct Fit {
  Values parameters;
  double cost = 0;
};

Fit fit_from(const System& system, Values parameters, const std::vector<Fault>& faults,
             std::span<const Recording> recordings, const How& how) {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (!system.parameters[i].fixed) free.push_back(i);
  Column residual = residuals(system, parameters, faults, recordings, how);
  double best = cost(residual), damping = 1e-3;
  for (int iteration = 0; iteration < 25 && damping < 1e8; ++iteration) {
    std::vector<Column> slopes;
    Values scale;
    How smooth = how;  // inside of a step that readings are rounded to nothing moves
    smooth.unrounded = true;
    const Column before_rounding = residuals(system, parameters, faults, recordings, smooth);
    for (std::size_t i : free) {
      const Parameter& p = system.parameters[i];
      scale.push_back(std::max(std::abs(p.nominal), 0.02 * (p.high - p.low)));
      Values moved = parameters;
      moved[i] += 1e-4 * scale.back();
      Column slope = residuals(system, moved, faults, recordings, smooth);
      for (std::size_t r = 0; r < slope.size(); ++r) slope[r] = (slope[r] - before_rounding[r]) / 1e-4;
      slopes.push_back(std::move(slope));
    }
    std::vector<Values> normal(free.size(), Values(free.size()));
    Values gradient(free.size());
    for (std::size_t i = 0; i < free.size(); ++i) {
      for (std::size_t j = 0; j < free.size(); ++j)
        for (std::size_t r = 0; r < residual.size(); ++r) normal[i][j] += slopes[i][r] * slopes[j][r];
      for (std::size_t r = 0; r < residual.size(); ++r) gradient[i] -= slopes[i][r] * residual[r];
    }
    const double before = best;
    for (; damping < 1e8; damping *= 6) {
      std::vector<Values> damped = normal;
      for (std::size_t i = 0; i < free.size(); ++i) damped[i][i] *= 1 + damping;
      const Values step = solve(damped, gradient);
      Values tried = parameters;
      for (std::size_t i = 0; i < free.size(); ++i) {
        const Parameter& p = system.parameters[free[i]];
        tried[free[i]] = std::clamp(tried[free[i]] + step[i] * scale[i], p.low, p.high);
      }
      Column now = residuals(system, tried, faults, recordings, how);
      if (cost(now) >= best) continue;
      best = cost(now);
      parameters = tried;
      residual = std::move(now);
      damping = std::max(damping / 10, 1e-7);
      break;
    }
    if (before - best < 1e-6 * before) break;
  }
  return {parameters, best};
}

}  // namespace

Values solve(std::vector<Values> a, Values b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t pivot = i;
    for (std::size_t r = i + 1; r < n; ++r)
      if (std::abs(a[r][i]) > std::abs(a[pivot][i])) pivot = r;
    std::swap(a[i], a[pivot]);
    std::swap(b[i], b[pivot]);
    if (a[i][i] == 0) a[i][i] = 1e-30;
    for (std::size_t r = i + 1; r < n; ++r) {
      const double share = a[r][i] / a[i][i];
      for (std::size_t c = i; c < n; ++c) a[r][c] -= share * a[i][c];
      b[r] -= share * b[i];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t c = i + 1; c < n; ++c) b[i] -= a[i][c] * b[c];
    b[i] /= a[i][i];
  }
  return b;
}

Column residuals(const System& system, const Values& parameters, const std::vector<Fault>& faults,
                 std::span<const Recording> recordings, const How& how) {
  Column all;
  for (const Recording& recording : recordings) {
    const Series series = system.simulate(parameters, faults, recording, how);
    for (std::size_t k = 0; k < series.outputs.size(); ++k) {
      double noise = system.noise[k];
      if (how.stepwise) noise = std::hypot(std::sqrt(2) * noise, system.process_noise[k]);
      for (std::size_t row = 0; row < series.outputs[k].size(); ++row) {
        const double reading = recording.readings[k][row];
        if (std::isfinite(reading) && !recording.outliers[k][row])
          all.push_back((reading - series.outputs[k][row]) / noise);
      }
    }
  }
  return all;
}

Values calibrate_from(const System& system, const Values& start, const std::vector<Fault>& faults,
                      std::span<const Recording> recordings, const How& how) {
  return fit_from(system, start, faults, recordings, how).parameters;
}

Values calibrate(const System& system, const std::vector<Fault>& faults, std::span<const Recording> recordings,
                 const How& how) {
  Values nominal;
  for (const Parameter& p : system.parameters) nominal.push_back(p.nominal);
  const Fit from_nominal = fit_from(system, nominal, faults, recordings, how);
  const Fit from_actual = fit_from(system, actual_values(system), faults, recordings, how);
  return from_nominal.cost < from_actual.cost ? from_nominal.parameters : from_actual.parameters;
}

}  // namespace plants

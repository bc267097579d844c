#include "identify.hpp"

#include <algorithm>
#include <cmath>

#include "regression.hpp"
#include "samples.hpp"

namespace sparse {
namespace {

using plants::Column;
using plants::Recording;
using plants::System;
using plants::Values;

constexpr double least_gain = 0.95;  // error with terms over error without, on held-out rows

std::vector<std::size_t> free_parameters(const System& system) {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < system.parameters.size(); ++i)
    if (!system.parameters[i].fixed) free.push_back(i);
  return free;
}

double small_change(const System& system, std::size_t parameter) {
  const plants::Parameter& p = system.parameters[parameter];
  return 1e-4 * std::max(std::abs(p.nominal), 0.02 * (p.high - p.low));
}

std::vector<Sample> collect_all(const Machine& machine, const Values& parameters,
                                std::span<const Recording> recordings) {
  std::vector<Sample> all;
  for (const Recording& recording : recordings) {
    const std::vector<Sample> own = collect(machine, recording, parameters);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

// The recordings as the calibrated model would have them: what smoothing alone makes of its rates.
std::vector<Recording> as_simulated(const Machine& machine, const Values& parameters,
                                    std::span<const Recording> recordings) {
  std::vector<Recording> simulated(recordings.begin(), recordings.end());
  for (Recording& recording : simulated) recording.readings = simulate(machine, parameters, {}, recording);
  return simulated;
}

// One row per sample: what the parameters and the terms could change in this component. What smoothing does to the
// rates is taken from `smoothed`, the same rows of simulated recordings.
Rows component_rows(const System& system, const Machine& machine, const Values& parameters,
                    const std::vector<Sample>& samples, const std::vector<Sample>& smoothed, std::size_t component,
                    const std::vector<std::size_t>& terms) {
  const std::vector<std::size_t> free = free_parameters(system);
  Rows rows;
  rows.kept = free.size();
  rows.columns.resize(free.size() + terms.size());
  for (std::size_t row = 0; row < samples.size(); ++row) {
    const Sample& sample = samples[row];
    if (!std::isfinite(sample.measured[component])) continue;
    const double expected = machine.model(parameters, *sample.recording, sample.at)[component];
    double bias = 0;
    if (!smoothed.empty()) {
      const Sample& twin = smoothed[row];
      bias = twin.measured[component] - machine.model(parameters, *twin.recording, twin.at)[component];
    }
    rows.target.push_back(sample.measured[component] - expected - bias);
    for (std::size_t i = 0; i < free.size(); ++i) {
      Values moved = parameters;
      const double change = small_change(system, free[i]);
      moved[free[i]] += change;
      rows.columns[i].push_back((machine.model(moved, *sample.recording, sample.at)[component] - expected) / change);
    }
    const double unit = machine.unit(parameters, *sample.recording);
    for (std::size_t k = 0; k < terms.size(); ++k)
      rows.columns[free.size() + k].push_back(unit * machine.terms[terms[k]].value(sample.at));
  }
  return rows;
}

// One row per final pose: how much the parameters and the terms would move it, by differences of simulations.
Rows final_rows(const System& system, const Machine& machine, const Values& parameters,
                std::span<const Recording> recordings) {
  const std::vector<std::size_t> free = free_parameters(system);
  Rows rows;
  rows.kept = free.size();
  rows.columns.resize(free.size() + machine.terms.size());
  const double usual[3] = {0.05, 0.05, 0.08};  // [m, m, rad] spread of final poses by the noise of the steps
  for (const Recording& recording : recordings) {
    const auto final_pose = [&](const Values& p, const Values& coefficients) {
      const std::vector<Column> pose = simulate(machine, p, coefficients, recording);
      return Triple{pose[0].back() / usual[0], pose[1].back() / usual[1], pose[2].back() / usual[2]};
    };
    const Triple expected = final_pose(parameters, {});
    const auto append = [&](std::size_t column, const Triple& moved, double change) {
      for (std::size_t k = 0; k < 3; ++k) rows.columns[column].push_back((moved[k] - expected[k]) / change);
    };
    for (std::size_t k = 0; k < 3; ++k) rows.target.push_back(recording.readings[k].back() / usual[k] - expected[k]);
    for (std::size_t i = 0; i < free.size(); ++i) {
      Values moved = parameters;
      moved[free[i]] += small_change(system, free[i]);
      append(i, final_pose(moved, {}), small_change(system, free[i]));
    }
    for (std::size_t k = 0; k < machine.terms.size(); ++k) {
      Values coefficients(machine.terms.size(), 0);
      coefficients[k] = 1e-5;
      append(free.size() + k, final_pose(parameters, coefficients), 1e-5);
    }
  }
  return rows;
}

std::vector<std::size_t> terms_of(const Machine& machine, std::size_t component) {
  std::vector<std::size_t> terms;
  for (std::size_t k = 0; k < machine.terms.size(); ++k)
    if (machine.terms[k].component == component) terms.push_back(k);
  return terms;
}

double size_of(const Column& column) {
  double sum = 0;
  for (double value : column) sum += value * value;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(column.size(), 1)));
}

void take_over(const Rows& rows, const Rows& check, const std::vector<std::size_t>& terms, Found& found) {
  if (rows.target.size() < rows.columns.size() || check.target.empty()) return;
  const Fit fit = regress(rows, check);
  if (fit.after > least_gain * fit.before) return;
  found.significant = true;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    found.coefficients[terms[k]] = fit.coefficients[rows.kept + k];
    found.importance[terms[k]] =
        std::abs(fit.coefficients[rows.kept + k]) * size_of(rows.columns[rows.kept + k]) / fit.after;
  }
}

}  // namespace

Found identify(const System& system, const Machine& machine, const Values& parameters, std::span<const Recording> fit,
               std::span<const Recording> check) {
  Found found;
  found.coefficients.assign(machine.terms.size(), 0);
  found.importance.assign(machine.terms.size(), 0);
  if (system.final_only) {
    std::vector<std::size_t> terms;
    for (std::size_t k = 0; k < machine.terms.size(); ++k) terms.push_back(k);
    take_over(final_rows(system, machine, parameters, fit), final_rows(system, machine, parameters, check), terms,
              found);
    return found;
  }
  const auto rows_of = [&](std::span<const Recording> recordings) {
    const std::vector<Sample> samples = collect_all(machine, parameters, recordings);
    const std::vector<Recording> simulated = as_simulated(machine, parameters, recordings);
    std::vector<Sample> smoothed;
    if (machine.motion != Motion::walk) smoothed = collect_all(machine, parameters, simulated);
    std::vector<Rows> rows;
    for (std::size_t component = 0; component < machine.components; ++component)
      rows.push_back(
          component_rows(system, machine, parameters, samples, smoothed, component, terms_of(machine, component)));
    return rows;
  };
  const std::vector<Rows> training = rows_of(fit), test = rows_of(check);
  for (std::size_t component = 0; component < machine.components; ++component)
    take_over(training[component], test[component], terms_of(machine, component), found);
  return found;
}

Sizes sizes_of_motion(const Machine& machine, const Values& parameters, std::span<const Recording> recordings) {
  std::vector<Sample> samples = collect_all(machine, parameters, recordings);
  if (!samples.empty()) return sizes_of(samples);
  for (const Recording& recording : recordings)  // final poses only: sizes of the orders
    for (std::size_t row = 0; row < recording.inputs[0].size(); ++row)
      samples.push_back({&recording, look_at(machine, recording, row), {}});
  return sizes_of(samples);
}

}  // namespace sparse

// Definitions of surefoot/diagnose/residual_tests/noise.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/residual_tests/noise.hpp"
#include "surefoot/diagnose/residual_tests/noise_model.hpp"
#include "surefoot/diagnose/text.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::vector<NoiseSeries> noise_parts(const std::vector<NoiseSeries>& series, std::size_t wanted) {
  std::vector<NoiseSeries> parts;
  for (const NoiseSeries& one : series) {
    const Eigen::Index size = one.value.size();
    const auto most = static_cast<Eigen::Index>((wanted + series.size() - 1) / series.size());
    const Eigen::Index count = std::clamp<Eigen::Index>(size / 40, 1, most);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index from = size * i / count, length = size * (i + 1) / count - from;
      parts.push_back(part_of(one, from, length));
    }
  }
  return parts;
}

SUREFOOT_ONCE std::pair<std::vector<double>, double> heldout_likelihood(const std::vector<NoiseSeries>& parts,
                                                                        const NoiseFit& all) {
  constexpr std::size_t folds = 4;
  std::vector<double> blocks;
  double samples = 0;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    std::vector<NoiseSeries> others;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i % folds != fold) others.push_back(parts[i]);
    }
    const ResidualNoise model = refit_noise(others, all);
    for (std::size_t i = fold; i < parts.size(); i += folds) {
      const Eigen::VectorXd each = log_likelihoods(model, parts[i]);
      const Eigen::Index count = blocks_of(each.size());
      for (Eigen::Index b = 0; b < count; ++b) {
        const Eigen::Index from = each.size() * b / count, to = each.size() * (b + 1) / count;
        blocks.push_back(Eigen::Map<const Eigen::VectorXd>(each.data() + from, to - from).sum());
      }
      samples += static_cast<double>(each.size());
    }
  }
  return {blocks, samples};
}

SUREFOOT_ONCE NoiseEvidence noise_evidence(const std::vector<NoiseSeries>& parts, const NoiseFit& with,
                                           const NoiseFit& without) {
  const auto [after, samples] = heldout_likelihood(parts, with);
  const auto [before, same] = heldout_likelihood(parts, without);
  std::vector<double> gains;
  double sum = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    gains.push_back(after[i] - before[i]);
    sum += gains.back();
  }
  if (gains.size() < 6 || !(samples > 0)) return {};
  return {sum / samples, student_tail(t_value(gains), static_cast<double>(gains.size()) - 1)};
}

SUREFOOT_ONCE NoiseFit best_memory(const std::vector<NoiseSeries>& series, const NoiseFit& white) {
  double samples = 0;
  for (const NoiseSeries& one : series) samples += static_cast<double>(one.value.size());
  const auto criterion = [&](const NoiseFit& fit) {
    return fit.shape.numbers() * std::log(samples) - 2 * fit.log_likelihood;
  };
  NoiseFit best = white;
  for (const NoiseMemory memory : {NoiseMemory::fading, NoiseMemory::fading_and_white}) {
    const NoiseFit one = fit_noise(series, {memory, white.shape.grows});
    if (criterion(one) < criterion(best)) best = one;
  }
  return best;
}

SUREFOOT_ONCE double typical_speed(const std::vector<NoiseSeries>& series) {
  double sum = 0, count = 0;
  for (const NoiseSeries& one : series) {
    sum += surefoot::detail::sum_of_squares(one.speed);
    count += static_cast<double>(one.speed.size());
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

SUREFOOT_ONCE std::vector<NoiseFinding> find_noise(const std::vector<NoiseSeries>& series, const OutputInfo& output,
                                                   SimulatorKind kind, std::size_t tests,
                                                   const NoiseCriteria& criteria) {
  const std::vector<NoiseSeries> parts = noise_parts(series, 8);
  if (parts.size() < 4) return {};
  const std::string time_unit = kind == SimulatorKind::ode ? "s" : "rows";
  const NoiseFit white = fit_noise(parts, {NoiseMemory::none, true}), remembering = best_memory(parts, white);
  const NoiseMemory memory = remembering.shape.memory;
  const auto convincing = [&](NoiseEvidence& evidence) {
    evidence.p_value = std::min(1.0, evidence.p_value * 2 * static_cast<double>(tests));
    return evidence.gain > criteria.gain && evidence.p_value < criteria.p_value;
  };

  NoiseEvidence remembers;
  bool correlated = false;
  if (memory != NoiseMemory::none) {
    remembers = noise_evidence(parts, remembering, white);
    correlated = convincing(remembers);
  }
  const NoiseFit& grown = correlated ? remembering : white;
  const NoiseFit constant = fit_noise(parts, {grown.shape.memory, false});
  NoiseEvidence grows = noise_evidence(parts, grown, constant);
  const bool growing = convincing(grows);
  const NoiseFit& fit = growing ? grown : constant;
  const double longest = fit.shape.memory == NoiseMemory::fading ? criteria.rows : criteria.rows_beside_white;
  const bool too_long = fit.model.time > longest * row_interval(series);
  if (correlated && too_long) return {};

  std::vector<NoiseFinding> findings;
  const auto number = [&fit](const char* name, const std::string& unit, double ResidualNoise::*of) {
    return FittedValue{name, unit, fit.model.*of, fit.low.*of, fit.high.*of};
  };
  if (growing) {
    const double speed = typical_speed(series);
    const bool compound = output.unit.find('/') != std::string::npos;
    const std::string per = (compound              ? "(" + output.unit + ")"
                             : output.unit.empty() ? "1"
                                                   : output.unit) +
                            (kind == SimulatorKind::ode ? "/s" : "/row");
    NoiseFinding one{output.name, "speed_dependent_noise", {}, grows.gain, grows.p_value, ""};
    one.parameters.push_back(number("rest", output.unit, &ResidualNoise::rest));
    one.parameters.push_back(number("growth", time_unit, &ResidualNoise::growth));
    one.sentence = "noise of " + output.name + " grows with its speed, from " + with_unit(fit.model.rest, output.unit) +
                   " at rest to " + with_unit(std::hypot(fit.model.rest, fit.model.growth * speed), output.unit) +
                   " at " + with_unit(speed, per);
    findings.push_back(std::move(one));
  }
  if (correlated) {
    NoiseFinding one{output.name, "correlated_noise", {}, remembers.gain, remembers.p_value, ""};
    one.parameters.push_back(number("time", time_unit, &ResidualNoise::time));
    if (memory == NoiseMemory::fading_and_white) one.parameters.push_back(number("share", "1", &ResidualNoise::share));
    one.sentence = "noise of " + output.name + " is correlated over " + with_unit(fit.model.time, time_unit);
    findings.push_back(std::move(one));
  }
  return findings;
}

SUREFOOT_ONCE NoiseSeries noise_series(const BoundSimulator& bound, std::size_t r, const SimulatedRun& run,
                                       Eigen::Index output, double size, bool stepwise) {
  const Recording& recording = bound.recordings[r];
  const std::vector<Cell> cells = cells_of(recording);
  const Eigen::VectorXd off = raw_residuals(bound, r, run, cells);
  const bool wrapped = bound.wrapped[static_cast<std::size_t>(output)];
  const auto speed = [&](Eigen::Index row) {
    const Eigen::Index from = std::max<Eigen::Index>(row - 1, 0);
    const Eigen::Index to = stepwise ? row : std::min(row + 1, recording.rows() - 1);
    double before = run.outputs(output, from);
    if (stepwise && std::isfinite(recording.outputs(output, from))) before = recording.outputs(output, from);
    const double moved = run.outputs(output, to) - before, time = recording.time[to] - recording.time[from];
    return time > 0 ? (wrapped ? wrap_angle(moved) : moved) / time : 0.0;
  };
  std::vector<double> times, values, speeds;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double value = off[static_cast<Eigen::Index>(i)];
    if (cells[i].output != output || !(std::abs(value) <= 6 * size)) continue;
    times.push_back(recording.time[cells[i].row]);
    values.push_back(value);
    speeds.push_back(speed(cells[i].row));
  }
  const auto vector = [](const std::vector<double>& v) {
    Eigen::VectorXd result(static_cast<Eigen::Index>(v.size()));
    std::copy(v.begin(), v.end(), result.data());
    return result;
  };
  NoiseSeries series{vector(times), vector(values), vector(speeds)};
  const double mean = series.value.size() > 0 ? series.value.mean() : 0;
  for (double& value : series.value) value -= mean;
  return series;
}

SUREFOOT_ONCE double equal_readings(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                    Eigen::Index output) {
  double equal = 0, count = 0;
  for (const std::size_t r : recordings) {
    const Eigen::VectorXd y = surefoot::detail::row_of(bound.recordings[r].outputs, output);
    for (Eigen::Index i = 1; i < y.size(); ++i) {
      if (!std::isfinite(y[i]) || !std::isfinite(y[i - 1])) continue;
      equal += y[i] == y[i - 1] ? 1 : 0;
      ++count;
    }
  }
  return count > 0 ? equal / count : 1;
}

SUREFOOT_ONCE std::vector<NoiseFinding> find_noise(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                   const std::vector<std::size_t>& recordings, NoiseKind noise,
                                                   const Parallel& parallel) {
  if (noise == NoiseKind::final_pose) return {};
  constexpr Eigen::Index most = 6000;  // samples of an output; more tell nothing new
  std::vector<std::size_t> some;
  Eigen::Index rows = 0;
  for (const std::size_t r : recordings) {
    if (rows > 0 && rows + bound.recordings[r].rows() > most) continue;
    some.push_back(r);
    rows += bound.recordings[r].rows();
  }
  const auto runs = simulate_all(bound, hypothesis, some, bound.integration, parallel);
  if (!holds_for_all(runs, [](const SimulatedRun& run) { return run.finite; })) return {};
  const Eigen::VectorXd sizes = residual_sizes(bound, some, runs);
  const std::size_t outputs = bound.info.outputs.size();
  std::vector<std::vector<NoiseFinding>> found(outputs);
  parallel(outputs, [&](std::size_t k) {
    const auto output = static_cast<Eigen::Index>(k);
    if (equal_readings(bound, some, output) > 0.4) return;
    std::vector<NoiseSeries> series;
    for (std::size_t i = 0; i < some.size(); ++i) {
      NoiseSeries one = noise_series(bound, some[i], runs[i], output, sizes[output], noise == NoiseKind::process);
      if (one.value.size() > most) one = part_of(one, 0, most);
      if (one.value.size() >= 8) series.push_back(std::move(one));
    }
    if (!series.empty()) found[k] = find_noise(series, bound.info.outputs[k], bound.info.kind, outputs);
  });
  std::vector<NoiseFinding> findings;
  for (const auto& one : found) append_items(findings, one);
  return findings;
}

}  // namespace surefoot::diagnosis

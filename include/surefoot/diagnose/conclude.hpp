// Draws the conclusions of an investigation: the verdict, the evidence on test recordings, what cannot be told apart.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/detect.hpp"
#include "surefoot/diagnose/forest_residual.hpp"
#include "surefoot/diagnose/locate.hpp"
#include "surefoot/diagnose/process_noise.hpp"
#include "surefoot/diagnose/select.hpp"
#include "surefoot/diagnose/split.hpp"
#include "surefoot/diagnose/wording.hpp"

namespace surefoot {

/// A diagnosis with everything it was drawn from.
struct Investigation {
  Diagnosis diagnosis;
  Rig rig;
  RecordingSplit split;
  SelectProblem problem;
  NoiseKind noise = NoiseKind::measurement;
  Hypothesis nominal;
  Comparison parameters_matter;  // nominal against calibrated
  Selection selection;
};

namespace detail {

inline std::vector<CalibratedParameter> calibrated_parameters(const Rig& rig, const Hypothesis& hypothesis,
                                                              const StandardErrors& errors) {
  std::vector<CalibratedParameter> result;
  for (std::size_t i = 0; i < rig.info.parameters.size(); ++i) {
    const ParameterInfo& info = rig.info.parameters[i];
    const double value = hypothesis.parameters[static_cast<Eigen::Index>(i)];
    CalibratedParameter one{{info.name, info.unit, value, value, value}, info.value, false, info.fixed};
    for (std::size_t v = 0; v < errors.variables.size(); ++v) {
      const Variable& variable = errors.variables[v];
      if (variable.kind != Variable::Kind::parameter || variable.index != i) continue;
      const double half = 1.96 * errors.deviation[static_cast<Eigen::Index>(v)];
      one.fit.low = std::max(value - half, info.low);
      one.fit.high = std::min(value + half, info.high);
      const double near = 1e-3 * (info.high - info.low);
      one.at_bound =
          value <= info.low + near * (variable.logarithmic ? value / info.high : 1) || value >= info.high - near;
    }
    result.push_back(one);
  }
  return result;
}

inline std::vector<std::string> correlated_pairs(const Rig& rig, const StandardErrors& errors) {
  std::vector<std::string> result;
  for (std::size_t a = 0; a < errors.variables.size(); ++a) {
    for (std::size_t b = a + 1; b < errors.variables.size(); ++b) {
      if (errors.variables[a].kind != Variable::Kind::parameter ||
          errors.variables[b].kind != Variable::Kind::parameter)
        continue;
      const double r = errors.correlation(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      if (std::abs(r) < 0.95) continue;
      result.push_back(rig.info.parameters[errors.variables[a].index].name + " and " +
                       rig.info.parameters[errors.variables[b].index].name + " (correlation " + in_digits(r) + ")");
    }
  }
  return result;
}

inline FoundEffect describe(const Rig& rig, const Hypothesis& hypothesis, std::size_t e, const StandardErrors* errors) {
  const AttachedEffect& attached = hypothesis.effects[e];
  FoundEffect found;
  found.name = attached.effect->name;
  found.attached_to = attached.place;
  found.form = attached.effect->form;
  if (attached.other >= 0) found.other = rig.info.states[static_cast<std::size_t>(attached.other)].name;
  const auto& parameters = attached.effect->parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double value = hypothesis.values[e][static_cast<Eigen::Index>(k)];
    FittedValue one{parameters[k].name, measure_unit(rig, attached, parameters[k].measure), value, value, value};
    if (errors != nullptr) {
      for (std::size_t v = 0; v < errors->variables.size(); ++v) {
        const Variable& variable = errors->variables[v];
        if (variable.kind != Variable::Kind::effect || variable.index != e || variable.item != k) continue;
        const double half = 1.96 * errors->deviation[static_cast<Eigen::Index>(v)];
        one.low = value - half;
        one.high = value + half;
      }
    }
    found.parameters.push_back(one);
  }
  found.sentence = fill_sentence(attached.effect->sentence, attached.place, found.parameters);
  return found;
}

/// Share of bootstrap repetitions (over blocks) in which `chosen` beats the parent and every alternative.
inline double bootstrap_confidence(const Judged& chosen, const Score& parent, const std::vector<Judged>& others,
                                   std::uint64_t seed) {
  const std::size_t n = chosen.heldout.blocks.size();
  if (n == 0) return 0;
  Rng rng(seed, 0xb007u);
  int wins = 0;
  constexpr int rounds = 400;
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> sums(others.size() + 2);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t b = rng.below(static_cast<std::uint32_t>(n));
      sums[0] += chosen.heldout.blocks[b];
      sums[1] += parent.blocks[b];
      for (std::size_t o = 0; o < others.size(); ++o) sums[o + 2] += others[o].heldout.blocks[b];
    }
    bool best = sums[0] < sums[1];
    for (std::size_t o = 0; o < others.size(); ++o) {
      // a model with more numbers has to be better by more than one per cent
      const double margin = others[o].numbers() > chosen.numbers() ? 0.99 : 1;
      best = best && sums[0] <= sums[o + 2] / margin;
    }
    wins += best ? 1 : 0;
  }
  return static_cast<double>(wins) / rounds;
}

/// Error of one recording over outputs, each in units of its scale; by output in `by_output` as sums of squares.
inline double recording_error(const Rig& rig, std::size_t r, const SimulatedRun& trajectory,
                              const Eigen::VectorXd& scale) {
  const std::vector<Cell> cells = cells_of(rig.recordings[r]);
  Eigen::VectorXd off = raw_residuals(rig, r, trajectory, cells);
  for (std::size_t i = 0; i < cells.size(); ++i) off[static_cast<Eigen::Index>(i)] /= scale[cells[i].output];
  return off.size() > 0 ? std::sqrt(off.squaredNorm() / static_cast<double>(off.size())) : 0;
}

inline double over_all(const std::vector<double>& errors, const std::vector<double>& counts) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    sum += errors[i] * errors[i] * counts[i];
    count += counts[i];
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

inline std::vector<double> cell_counts(const Rig& rig, const std::vector<std::size_t>& recordings) {
  std::vector<double> counts;
  for (const std::size_t r : recordings) counts.push_back(static_cast<double>(cells_of(rig.recordings[r]).size()));
  return counts;
}

/// Executor on top of Parallel, for the forest.
struct ParallelExecutor {
  const Parallel* parallel;
  std::size_t width() const { return 1; }
  template <class Job>
  bool run(std::size_t count, Job&& job, std::stop_token = {}) const {
    (*parallel)(count, [&](std::size_t i) { job(i); });
    return true;
  }
};

}  // namespace detail

/// How much of the mean square that is not noise, over all outputs in units of sigma.
struct Mismatch {
  double energy = 0;   // sum over outputs of share * mean square / sigma^2
  double share = 0;    // largest over outputs
  double p_value = 1;  // smallest over outputs, corrected for their number
};

inline Mismatch measure_mismatch(const Rig& rig, const std::vector<std::size_t>& recordings,
                                 const std::vector<SimulatedRun>& trajectories, const Eigen::VectorXd& sigma,
                                 NoiseKind noise, std::vector<Structure>* by_output = nullptr) {
  Mismatch result;
  for (Eigen::Index k = 0; k < sigma.size(); ++k) {
    Structure structure;
    if (noise == NoiseKind::process) {  // errors of single steps: any lag may show it, a gait has a period
      constexpr Eigen::Index lags = 4;
      for (Eigen::Index lag = 1; lag <= lags; ++lag) {
        Structure one = residual_structure(rig, recordings, trajectories, k, lag, lag);
        one.p_value = std::min(1.0, one.p_value * lags);
        if (one.p_value < structure.p_value || lag == 1) structure = one;
      }
    } else {
      structure = residual_structure(rig, recordings, trajectories, k, 6, 12);
    }
    if (by_output != nullptr) by_output->push_back(structure);
    result.energy += structure.share * structure.rms * structure.rms / (sigma[k] * sigma[k]);
    if (structure.p_value < 0.01) result.share = std::max(result.share, structure.share);
    result.p_value = std::min(result.p_value, structure.p_value * static_cast<double>(sigma.size()));
  }
  return result;
}

namespace detail {

/// Errors on the test recordings: whole recordings are simulated, whatever the fit did.
inline void prove(Investigation& investigation, const Hypothesis& calibrated, const Hypothesis& chosen,
                  const Parallel& parallel, std::uint64_t seed) {
  const Rig& rig = investigation.rig;
  Diagnosis& diagnosis = investigation.diagnosis;
  const auto& training = investigation.split.training;
  const auto& test = investigation.split.test;
  Integration whole = rig.integration;
  whole.restart = 0;
  std::vector<std::size_t> all(rig.recordings.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Eigen::VectorXd spreads = output_spreads(rig, all);
  Eigen::VectorXd scale = spreads;
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    const double noise = rig.info.outputs[static_cast<std::size_t>(k)].noise;
    if (noise > 0) scale[k] = noise;
  }
  // Unknown initial states of test recordings are estimated for each model alike.
  FitProblem initial = investigation.problem.fit;
  initial.recordings = test;
  initial.free = Free::initial_only;
  const bool free = free_start(rig, test);
  const auto ready = [&](const Hypothesis& h) { return free ? fit(rig, h, initial, parallel).hypothesis : h; };
  const Hypothesis models[3] = {ready(investigation.nominal), ready(calibrated), ready(chosen)};
  std::vector<SimulatedRun> runs[3];
  for (int m = 0; m < 3; ++m) runs[m] = simulate_all(rig, models[m], test, whole, parallel);

  std::vector<double> errors[3];
  for (std::size_t i = 0; i < test.size(); ++i) {
    for (int m = 0; m < 3; ++m) errors[m].push_back(recording_error(rig, test[i], runs[m][i], scale));
    diagnosis.per_recording.push_back({rig.recordings[test[i]].name, errors[1][i], errors[2][i]});
    diagnosis.curves.push_back({rig.recordings[test[i]].name, rig.recordings[test[i]].time,
                                rig.recordings[test[i]].inputs, rig.recordings[test[i]].outputs, runs[0][i].outputs,
                                runs[1][i].outputs, runs[2][i].outputs});
  }
  const std::vector<double> counts = cell_counts(rig, test);
  diagnosis.test_before = over_all(errors[1], counts);
  diagnosis.test_after = over_all(errors[2], counts);

  std::vector<double> trained[2];
  const auto before = simulate_all(rig, calibrated, training, whole, parallel);
  const auto after = simulate_all(rig, chosen, training, whole, parallel);
  for (std::size_t i = 0; i < training.size(); ++i) {
    trained[0].push_back(recording_error(rig, training[i], before[i], scale));
    trained[1].push_back(recording_error(rig, training[i], after[i], scale));
  }
  diagnosis.train_before = over_all(trained[0], cell_counts(rig, training));
  diagnosis.train_after = over_all(trained[1], cell_counts(rig, training));

  // 95 % interval of the ratio, over test recordings.
  Rng rng(seed, 0x7e57u);
  std::vector<double> ratios;
  for (int round = 0; round < 400; ++round) {
    double a = 0, b = 0;
    for (std::size_t i = 0; i < test.size(); ++i) {
      const std::size_t j = rng.below(static_cast<std::uint32_t>(test.size()));
      a += errors[1][j] * errors[1][j] * counts[j];
      b += errors[2][j] * errors[2][j] * counts[j];
    }
    ratios.push_back(a > 0 ? std::sqrt(b / a) : 1);
  }
  std::sort(ratios.begin(), ratios.end());
  diagnosis.gain_low = ratios[9];
  diagnosis.gain_high = ratios[389];

  // A forest on the residuals of the calibrated model instead.
  Eigen::Index rows = 0, test_rows = 0;
  for (const std::size_t r : training) rows += rig.recordings[r].rows();
  for (const std::size_t r : test) test_rows += rig.recordings[r].rows();
  if (investigation.noise != NoiseKind::final_pose) {
    const FeatureTable table = make_features(rig, training, before, std::max<Eigen::Index>(1, rows / 8000));
    const ResidualForest forest = train_residual_forest(table, residual_table(rig, training, before, scale, table),
                                                        ParallelExecutor{&parallel}, seed);
    const FeatureTable unseen = make_features(rig, test, runs[1], std::max<Eigen::Index>(1, test_rows / 8000));
    const Eigen::MatrixXd residuals = residual_table(rig, test, runs[1], scale, unseen);
    const double untouched =
        std::sqrt(residuals.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, residuals.size())));
    if (untouched > 0)
      diagnosis.test_forest = diagnosis.test_before * left_after(forest, unseen, residuals) / untouched;
  }

  // By output.
  std::vector<Structure> structures;
  measure_mismatch(rig, training, simulate_all(rig, calibrated, training, rig.integration, parallel),
                   investigation.problem.fit.weighting.sigma, investigation.noise, &structures);
  double floor = 0;
  for (std::size_t k = 0; k < rig.info.outputs.size(); ++k) {
    const auto output = static_cast<Eigen::Index>(k);
    ChannelMismatch channel;
    channel.output = rig.info.outputs[k].name;
    channel.unit = rig.info.outputs[k].unit;
    double sums[3] = {}, count = 0;
    for (std::size_t i = 0; i < test.size(); ++i) {
      for (int m = 0; m < 3; ++m) sums[m] += series_of(rig, test[i], runs[m][i], output).squaredNorm();
      for (const Cell& cell : cells_of(rig.recordings[test[i]])) count += cell.output == output ? 1 : 0;
    }
    count = std::max(count, 1.0);
    channel.rmse_nominal = std::sqrt(sums[0] / count);
    channel.rmse_calibrated = std::sqrt(sums[1] / count);
    channel.rmse_after = std::sqrt(sums[2] / count);
    const double stated = rig.info.outputs[k].noise;
    channel.noise = stated > 0 ? stated : std::min(fast_noise(rig, training, output), channel.rmse_after);
    channel.p_value = structures[k].p_value;
    floor +=
        channel.noise * channel.noise / (scale[output] * scale[output]) / static_cast<double>(rig.info.outputs.size());
    diagnosis.channels.push_back(channel);
  }
  diagnosis.noise_floor = std::sqrt(floor);
}

inline void locate(Investigation& investigation, const Hypothesis& calibrated, const Parallel& parallel,
                   std::uint64_t seed) {
  const Rig& rig = investigation.rig;
  if (investigation.noise == NoiseKind::final_pose) return;
  const auto& recordings = investigation.split.training;
  const auto trajectories = simulate_all(rig, calibrated, recordings, rig.integration, parallel);
  Eigen::Index rows = 0;
  for (const std::size_t r : recordings) rows += rig.recordings[r].rows();
  const FeatureTable table = make_features(rig, recordings, trajectories, std::max<Eigen::Index>(1, rows / 4000));
  const Eigen::Index horizon = investigation.noise == NoiseKind::process ? 0 : 10;
  const Eigen::VectorXd energy =
      mismatch_energy(rig, recordings, trajectories, investigation.problem.fit.weighting.sigma, table, horizon);
  investigation.diagnosis.regions = find_region(table, energy, 2, 60, seed);
  investigation.diagnosis.intervals = find_intervals(rig, recordings, table, energy, 6);
}

inline std::string names_of(const Hypothesis& hypothesis) {
  std::vector<std::string> names;
  for (const AttachedEffect& effect : hypothesis.effects) names.push_back(effect.effect->name);
  return in_list(names);
}

}  // namespace detail

/// Fills in the diagnosis from what the search found.
inline void conclude(Investigation& investigation, const std::vector<AttachedEffect>& candidates,
                     const Parallel& parallel, std::uint64_t seed) {
  Diagnosis& diagnosis = investigation.diagnosis;
  const Rig& rig = investigation.rig;
  const FitProblem& problem = investigation.problem.fit;
  Selection& selection = investigation.selection;
  const auto& training = investigation.split.training;
  const Hypothesis calibrated = selection.nominal.hypothesis;
  const Hypothesis chosen = selection.chosen.hypothesis;
  const std::size_t known = calibrated.effects.size();
  const bool found_any = chosen.effects.size() > known;
  diagnosis.integration_order = rig.integration.order;
  diagnosis.integration_step = rig.integration.step;

  // What is left before and after.
  const auto before = simulate_all(rig, calibrated, training, rig.integration, parallel);
  const auto after = simulate_all(rig, chosen, training, rig.integration, parallel);
  const Eigen::VectorXd& sigma = problem.weighting.sigma;
  Mismatch missing, left;
  if (investigation.noise != NoiseKind::final_pose) {
    missing = measure_mismatch(rig, training, before, sigma, investigation.noise);
    left = measure_mismatch(rig, training, after, sigma, investigation.noise);
  }
  const double still = missing.energy > 0 ? left.energy / missing.energy : 0;
  const double tolerated = investigation.noise == NoiseKind::process ? 0.12 : 0.3;
  const bool open = left.p_value < 0.01 && left.share > tolerated && (!found_any || still > 0.2);
  if (open) {
    diagnosis.verdict = Verdict::unexplained;
  } else if (found_any) {
    diagnosis.verdict = Verdict::missing_physics;
  } else if (investigation.parameters_matter.gain > 0.02 && investigation.parameters_matter.t > 2) {
    diagnosis.verdict = Verdict::parameters_only;
  } else {
    diagnosis.verdict = Verdict::adequate;
  }

  const StandardErrors nominal_errors = standard_errors(rig, calibrated, problem, parallel);
  diagnosis.parameters = detail::calibrated_parameters(rig, calibrated, nominal_errors);
  diagnosis.correlated = detail::correlated_pairs(rig, nominal_errors);
  const StandardErrors errors = !found_any ? nominal_errors : standard_errors(rig, chosen, problem, parallel);
  diagnosis.augmented_parameters = detail::calibrated_parameters(rig, chosen, errors);
  diagnosis.noise_sentence =
      investigation.noise == NoiseKind::measurement ? "noise of measurement: whole recordings are simulated"
      : investigation.noise == NoiseKind::process
          ? "noise of the process accumulates: each row is predicted from the one before"
          : "noise of the process accumulates until the final pose: poses are weighed by its covariance";

  for (std::size_t e = 0; e < chosen.effects.size(); ++e) {
    FoundEffect found = detail::describe(rig, chosen, e, &errors);
    if (e < known) {
      diagnosis.known_effects.push_back(found);
      continue;
    }
    const Comparison evidence = e - known < selection.evidence.size() ? selection.evidence[e - known] : Comparison{};
    std::vector<Judged> rivals;
    for (const Judged& other : selection.alternatives) {
      if (other.hypothesis.effects.size() == chosen.effects.size()) rivals.push_back(other);
    }
    found.evidence = {evidence.gain, evidence.stderr_,
                      std::min(1.0, evidence.p_value * static_cast<double>(selection.candidates)),
                      detail::bootstrap_confidence(selection.chosen, selection.nominal.heldout, rivals, seed)};
    diagnosis.effects.push_back(found);
  }

  // What might stand in their place.
  std::stable_sort(selection.alternatives.begin(), selection.alternatives.end(),
                   [](const Judged& a, const Judged& b) { return a.heldout.total() < b.heldout.total(); });
  std::vector<std::string> twins;
  const Judged* first_twin = nullptr;
  for (const Judged& other : selection.alternatives) {
    Alternative alternative;
    alternative.heldout_rmse = other.heldout.rms();
    for (const AttachedEffect& effect : other.hypothesis.effects)
      alternative.effects.emplace_back(effect.effect->name, effect.place);
    const bool same_names = std::all_of(
        other.hypothesis.effects.begin(), other.hypothesis.effects.end(), [&](const AttachedEffect& effect) {
          return std::any_of(chosen.effects.begin(), chosen.effects.end(), [&](const AttachedEffect& mine) {
            return mine.effect->name == effect.effect->name && mine.at == effect.at &&
                   mine.effect->place == effect.effect->place;
          });
        });
    if (same_names) continue;  // another form of the same
    const Comparison worse = compare_scores(other.heldout, selection.chosen.heldout);
    alternative.indistinguishable = found_any && worse.gain < 0.1 && (worse.t < 2 || worse.gain < 0.01);
    if (alternative.indistinguishable) {
      twins.push_back(detail::names_of(other.hypothesis));
      if (first_twin == nullptr) first_twin = &other;
    }
    diagnosis.alternatives.push_back(alternative);
  }
  if (first_twin != nullptr) {
    const Effect& mine = *chosen.effects.back().effect;
    const Effect& other = *first_twin->hypothesis.effects.back().effect;
    diagnosis.next_experiment = mine.experiment + ": separates " + mine.name + " from " + other.name;
    if (!other.experiment.empty() && other.experiment != mine.experiment) {
      diagnosis.next_experiment += "; or " + other.experiment;
    }
  }

  detail::locate(investigation, calibrated, parallel, seed);
  detail::prove(investigation, calibrated, chosen, parallel, seed);

  if (!found_any && diagnosis.verdict != Verdict::unexplained) {
    FitProblem few = problem;
    few.recordings = investigation.problem.screened;
    for (const Proposal& proposal : propose(rig, calibrated, few, candidates, parallel)) {
      for (std::size_t k = 0; k < proposal.effect.effect->parameters.size() && proposal.visible > 0; ++k) {
        const EffectParameter& parameter = proposal.effect.effect->parameters[k];
        if (!parameter.strength) continue;
        diagnosis.limits.push_back({proposal.effect.effect->name,
                                    proposal.effect.place,
                                    {parameter.name, measure_unit(rig, proposal.effect, parameter.measure),
                                     std::abs(proposal.visible) * proposal.tried[static_cast<Eigen::Index>(k)], 0, 0}});
        break;
      }
    }
    std::stable_sort(diagnosis.limits.begin(), diagnosis.limits.end(),
                     [](const DetectionLimit& a, const DetectionLimit& b) { return a.name < b.name; });
  }

  std::vector<std::string> sentences;
  for (const FoundEffect& effect : diagnosis.effects) sentences.push_back(effect.sentence);
  const std::string percent = in_digits(100 * (1 - diagnosis.test_after / std::max(diagnosis.test_before, 1e-300)));
  switch (diagnosis.verdict) {
    case Verdict::adequate:
      diagnosis.sentence = "Nothing is missing: with its nominal parameters the model agrees with the recordings.";
      break;
    case Verdict::parameters_only:
      diagnosis.sentence = "Nothing is missing: with calibrated parameters the model agrees with the recordings.";
      break;
    case Verdict::missing_physics:
      diagnosis.sentence = "Left out of the model: " + in_list(sentences) +
                           ". With that, the error on recordings never used falls by " + percent + " %.";
      break;
    case Verdict::unexplained:
      diagnosis.sentence = "The model leaves something out that no known effect explains";
      if (!sentences.empty()) diagnosis.sentence += "; a part of it: " + in_list(sentences);
      if (!diagnosis.regions.empty()) diagnosis.sentence += "; it shows where " + diagnosis.regions.front().rule;
      diagnosis.sentence += ".";
      break;
  }
  if (!twins.empty() && diagnosis.verdict == Verdict::missing_physics) {
    diagnosis.sentence += " These recordings cannot tell it from " + in_list(twins) + ".";
  }
}

}  // namespace surefoot

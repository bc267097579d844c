// Proposes effects: every effect at every place where it may attach, ranked by how much of the residuals the change of
// the simulation that it causes would explain, apart from what the model's own parameters could do.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "surefoot/diagnose/fit.hpp"

namespace surefoot {

/// Inputs and signals (after the inputs) that are worth an effect: they change, and are no mere multiple of one before.
inline std::vector<bool> distinct_inputs(const Rig& rig, const Hypothesis& hypothesis,
                                         const std::vector<std::size_t>& recordings,
                                         const std::vector<SimulatedRun>& trajectories) {
  const std::size_t inputs = rig.info.inputs.size(), count = inputs + rig.info.signals.size();
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
  std::vector<bool> changes(count, false);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (!trajectories[i].finite) continue;
    Eigen::MatrixXd efforts, signals;
    rig.probe(rig, recordings[i], hypothesis.parameters, trajectories[i].states, efforts, signals);
    Eigen::MatrixXd all(products.rows(), signals.cols());
    all << rig.recordings[recordings[i]].inputs, signals;
    all = all.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }).eval();
    products += all * all.transpose();
    for (std::size_t k = 0; k < count; ++k) {
      const auto line = all.row(static_cast<Eigen::Index>(k));
      changes[k] = changes[k] || line.maxCoeff() > line.minCoeff();
    }
  }
  std::vector<bool> distinct(count, false);
  for (std::size_t k = 0; k < count; ++k) {
    const auto a = static_cast<Eigen::Index>(k);
    distinct[k] = changes[k] && (k < inputs || rig.facts.driven_signal[k - inputs]);
    for (std::size_t j = 0; j < k; ++j) {
      const auto b = static_cast<Eigen::Index>(j);
      if (!distinct[j]) continue;
      const double cosine = products(a, b) / std::sqrt(std::max(products(a, a) * products(b, b), 1e-300));
      if (std::abs(cosine) > 1 - 1e-9) distinct[k] = false;
    }
  }
  return distinct;
}

/// Every (effect, place) that fits the simulator; `distinct` as above.
inline std::vector<AttachedEffect> attachments(const Rig& rig, const std::vector<Effect>& effects,
                                               const std::vector<bool>& distinct) {
  std::vector<AttachedEffect> result;
  const SimulatorInfo& info = rig.info;
  int rank = -1;
  for (const Effect& effect : effects) {
    ++rank;
    if (effect.needs_drive && info.inputs.empty()) continue;  // nothing drives it
    const auto shared = std::make_shared<const Effect>(effect);
    const auto attach = [&](std::size_t at, const std::string& place, int other = -1) {
      result.push_back({shared, static_cast<int>(at), other, place, rank});
    };
    switch (effect.place) {
      case Place::velocity:
        for (std::size_t i = 0; i < info.states.size(); ++i) {
          const bool positioned = rig.facts.position_of[i] >= 0;
          bool needs_position = effect.seen_position || effect.limit;
          for (const EffectParameter& parameter : effect.parameters) {
            needs_position = needs_position || parameter.measure.position != 0;
          }
          if (rig.facts.velocity[i] && (positioned || !needs_position)) attach(i, info.states[i].name);
        }
        break;
      case Place::state:
        for (std::size_t i = 0; i < info.states.size(); ++i) {
          bool is_position = false;
          for (const int position : rig.facts.position_of) is_position = is_position || position == static_cast<int>(i);
          const bool pose =
              info.planar && (static_cast<int>(i) == info.planar->x || static_cast<int>(i) == info.planar->y ||
                              static_cast<int>(i) == info.planar->heading);
          if (is_position || rig.facts.velocity[i] || pose) continue;  // there forces act, or walking effects
          if (!effect.spills) {
            attach(i, info.states[i].name);
            continue;
          }
          for (std::size_t j = 0; j < info.states.size(); ++j) {
            if (j != i) attach(i, info.states[i].name, static_cast<int>(j));
          }
        }
        break;
      case Place::input:
        for (std::size_t i = 0; i < distinct.size(); ++i) {
          if (!distinct[i] || (effect.delay && i >= info.inputs.size())) continue;
          attach(i, i < info.inputs.size() ? info.inputs[i].name : info.signals[i - info.inputs.size()]);
        }
        break;
      case Place::output:
        for (std::size_t i = 0; i < info.outputs.size(); ++i) attach(i, info.outputs[i].name);
        break;
      case Place::planar:
        if (info.planar) attach(0, "planar");
        break;
      case Place::parameter:
        for (std::size_t i = 0; i < info.parameters.size(); ++i) {
          if (!info.parameters[i].fixed) attach(i, info.parameters[i].name);
        }
        break;
    }
  }
  return result;
}

/// An effect that is worth a fit, with the numbers to start it from.
struct Proposal {
  AttachedEffect effect;
  Eigen::VectorXd start;
  double gain = 0;                           // share of the squared residuals it would explain
  double distinct = 0;                       // share of its mark that the parameters cannot imitate
  Eigen::VectorXd tried;                     // the numbers it was screened with
  std::vector<Eigen::VectorXd> more_starts;  // worse ones; for effects without a strength the order means little
  double visible = 0;  // multiple of those that would take away a twentieth of the residuals' squares
};

namespace detail {

/// Largest absolute value of what an effect is attached to: of its position if it is a velocity.
inline double peak_at(const Rig& rig, const AttachedEffect& attached) {
  const auto at = static_cast<std::size_t>(attached.at);
  const std::size_t inputs = rig.info.inputs.size();
  double peak = 1;
  if (attached.effect->place == Place::velocity) {
    const int position = rig.facts.position_of[at];
    peak = rig.sizes.state_peak[position >= 0 ? static_cast<std::size_t>(position) : at];
  } else if (attached.effect->place == Place::state) {
    peak = rig.sizes.state_peak[at];
  } else if (attached.effect->place == Place::input) {
    peak = at < inputs ? rig.sizes.input_peak[at] : rig.sizes.signal_peak[at - inputs];
  }
  return peak > 0 ? peak : 1;
}

/// Every combination of the starting values, in units of the model.
inline std::vector<Eigen::VectorXd> starts_of(const Rig& rig, const AttachedEffect& attached) {
  const auto& parameters = attached.effect->parameters;
  std::vector<Eigen::VectorXd> result{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters.size()))};
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double unit =
        parameters[k].of_peak ? peak_at(rig, attached) : measure_size(rig, attached, parameters[k].measure);
    std::vector<Eigen::VectorXd> longer;
    for (const Eigen::VectorXd& one : result) {
      for (const double start : parameters[k].starts) {
        longer.push_back(one);
        longer.back()[static_cast<Eigen::Index>(k)] = start * unit;
      }
    }
    result = std::move(longer);
  }
  if (attached.effect->suggest && attached.effect->place == Place::output) {
    std::vector<double> readings;
    for (const Recording& recording : rig.recordings) {
      for (const double value : recording.outputs.row(attached.at)) {
        if (std::isfinite(value)) readings.push_back(value);
      }
    }
    for (const double value : attached.effect->suggest(readings)) {
      result.push_back(result.front());
      result.back()[0] = value;
    }
  }
  return result;
}

}  // namespace detail

/// Ranks candidates, best first. `base` is fitted; only `problem.recordings` are simulated, once per candidate, start
/// and strength. Residuals beyond the robust limit are cut off there.
inline std::vector<Proposal> propose(const Rig& rig, const Hypothesis& base, const FitProblem& problem,
                                     const std::vector<AttachedEffect>& candidates, const Parallel& parallel) {
  const detail::FitFunctions functions(rig, base, problem, parallel);
  const Eigen::VectorXd z = functions.start();
  const double limit = problem.weighting.robust;
  const auto clipped = [limit](const Eigen::VectorXd& r) -> Eigen::VectorXd {
    return r.unaryExpr([limit](double value) { return std::isfinite(value) ? std::clamp(value, -limit, limit) : 0.0; });
  };
  const Eigen::VectorXd residuals = functions.residuals(z);
  Eigen::MatrixXd basis;
  if (z.size() > 0) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(functions.jacobian(z));
    basis = qr.householderQ() * Eigen::MatrixXd::Identity(residuals.size(), qr.rank());
  }
  const auto beyond_parameters = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    if (basis.cols() == 0) return v;
    return v - basis * (basis.transpose() * v);
  };
  const Eigen::VectorXd open = beyond_parameters(clipped(residuals));
  const double energy = std::max(open.squaredNorm(), 1e-300);

  struct Job {
    std::size_t candidate;
    Eigen::VectorXd start;
  };
  std::vector<Job> jobs;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    for (const Eigen::VectorXd& start : detail::starts_of(rig, candidates[c])) jobs.push_back({c, start});
  }
  std::vector<Proposal> tried(jobs.size());
  parallel(jobs.size(), [&](std::size_t j) {
    const AttachedEffect& candidate = candidates[jobs[j].candidate];
    const auto& parameters = candidate.effect->parameters;
    std::vector<Eigen::Index> strengths;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (parameters[k].strength) strengths.push_back(static_cast<Eigen::Index>(k));
    }
    const auto marks = static_cast<Eigen::Index>(std::max<std::size_t>(1, strengths.size()));
    Eigen::MatrixXd marked(residuals.size(), marks);
    double all = 0;
    for (Eigen::Index m = 0; m < marks; ++m) {
      Eigen::VectorXd values = jobs[j].start;
      if (!strengths.empty()) {
        for (const Eigen::Index k : strengths) {
          if (k != strengths[static_cast<std::size_t>(m)]) values[k] = 0;
        }
      }
      Hypothesis with = base;
      with.effects.push_back(candidate);
      with.values.push_back(values);
      const detail::FitFunctions changed(rig, with, problem, serially());
      const Eigen::VectorXd after = changed.residuals(changed.start());
      if (!after.allFinite()) return;
      const Eigen::VectorXd mark = after - residuals;
      all += mark.squaredNorm();
      marked.col(m) = beyond_parameters(mark);
    }
    Proposal& proposal = tried[j];
    proposal.effect = candidate;
    proposal.start = jobs[j].start;
    proposal.tried = jobs[j].start;
    const double left = marked.squaredNorm();
    proposal.distinct = all > 0 ? std::sqrt(left / all) : 0;
    if (!(left > 1e-12 * energy)) return;
    proposal.visible = std::sqrt(0.05 * energy / left);
    Eigen::VectorXd share = (marked.transpose() * marked + 1e-12 * left * Eigen::MatrixXd::Identity(marks, marks))
                                .ldlt()
                                .solve(-marked.transpose() * open);
    for (Eigen::Index m = 0; m < marks; ++m) {
      if (strengths.empty()) {
        share[m] = std::clamp(share[m], 0.0, 1.0);
        continue;
      }
      const Eigen::Index k = strengths[static_cast<std::size_t>(m)];
      const EffectParameter& parameter = parameters[static_cast<std::size_t>(k)];
      const double unit = measure_size(rig, candidate, parameter.measure), start = jobs[j].start[k];
      const double a = parameter.low * unit / start, b = parameter.high * unit / start;
      share[m] = std::clamp(share[m], std::min(a, b), std::max(a, b));
      proposal.start[k] = share[m] * start;
    }
    proposal.gain = 1 - (open + marked * share).squaredNorm() / energy;
  });
  std::vector<Proposal> best;
  for (std::size_t j = 0; j < tried.size(); ++j) {
    if (!tried[j].effect.effect) continue;
    const auto same = std::find_if(best.begin(), best.end(),
                                   [&](const Proposal& other) { return same_effect(other.effect, tried[j].effect); });
    if (same == best.end()) {
      best.push_back(tried[j]);
      continue;
    }
    if (tried[j].gain > same->gain) std::swap(*same, tried[j]);
    same->more_starts.insert(same->more_starts.end(), tried[j].more_starts.begin(), tried[j].more_starts.end());
    same->more_starts.push_back(tried[j].start);
  }
  std::ranges::sort(best, [](const Proposal& a, const Proposal& b) { return a.gain > b.gain; });
  return best;
}

}  // namespace surefoot

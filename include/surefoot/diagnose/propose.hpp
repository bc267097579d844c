// Proposes effects: every effect at every place where it may attach, ranked by how much of the residuals the change of
// the simulation that it causes would explain, apart from what the model's own parameters could do.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "surefoot/diagnose/attachments.hpp"
#include "surefoot/diagnose/fit.hpp"
#include "surefoot/diagnose/starting_values.hpp"

namespace surefoot {

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
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(functions.jacobian(z, residuals));
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
  const auto observed = detail::observe(rig, problem.recordings,
                                        simulate_all(rig, base, problem.recordings, problem.integration, parallel));
  std::vector<std::vector<Eigen::VectorXd>> starts(candidates.size());
  parallel(candidates.size(), [&](std::size_t c) { starts[c] = detail::starts_of(rig, candidates[c], observed); });
  std::vector<Job> jobs;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    for (const Eigen::VectorXd& start : starts[c]) jobs.push_back({c, start});
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
      if (candidate.effect->impacts) {
        share[m] = 1;
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
  std::erase_if(tried, [](const Proposal& one) { return !one.effect.effect; });
  std::ranges::sort(tried, std::greater{}, &Proposal::gain);
  std::vector<Proposal> best;  // of each effect, with its other starts in their order
  for (const Proposal& one : tried) {
    const auto same = std::find_if(best.begin(), best.end(),
                                   [&](const Proposal& other) { return same_effect(other.effect, one.effect); });
    if (same == best.end()) {
      best.push_back(one);
    } else {
      same->more_starts.push_back(one.start);
    }
  }
  return best;
}

}  // namespace surefoot

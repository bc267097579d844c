// Definitions of surefoot/diagnose/selection/propose.hpp.
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

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/starting_values.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"
#include "surefoot/diagnose/selection/propose.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE std::vector<Proposal> propose(const BoundSimulator& bound, const Hypothesis& base,
                                              const FitProblem& problem, const std::vector<AttachedEffect>& candidates,
                                              const Parallel& parallel) {
  const FitFunctions functions(bound, base, problem, parallel);
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
  const auto observed =
      observe(bound, problem.recordings, simulate_all(bound, base, problem.recordings, problem.integration, parallel));
  std::vector<std::vector<Eigen::VectorXd>> starts(candidates.size());
  parallel(candidates.size(), [&](std::size_t c) { starts[c] = starts_of(bound, candidates[c], observed); });
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
      const FitFunctions changed(bound, with, problem, serially());
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
      if (candidate.effect->is_impulsive) {
        share[m] = 1;
        continue;
      }
      const Eigen::Index k = strengths[static_cast<std::size_t>(m)];
      const EffectParameter& parameter = parameters[static_cast<std::size_t>(k)];
      const double unit = measure_size(bound, candidate, parameter.measure), start = jobs[j].start[k];
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

}  // namespace surefoot::diagnosis

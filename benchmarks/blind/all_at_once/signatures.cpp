#include "signatures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "surefoot/diagnose/selection/propose.hpp"

using namespace surefoot::diagnosis;

namespace all_at_once {
namespace {

// Starting values where only one strength is left.
Eigen::VectorXd alone(const surefoot::AttachedEffect& candidate, Eigen::VectorXd values, int parameter) {
  const auto& parameters = candidate.effect->parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (parameter >= 0 && parameters[k].strength && static_cast<int>(k) != parameter) {
      values[static_cast<Eigen::Index>(k)] = 0;
    }
  }
  return values;
}

std::vector<Unknown> unknowns_of(const BoundSimulator& bound, const surefoot::AttachedEffect& candidate,
                                 const Eigen::VectorXd& start, std::size_t index) {
  std::vector<Unknown> result;
  const auto& parameters = candidate.effect->parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (!parameters[k].strength) continue;
    const double unit = measure_size(bound, candidate, parameters[k].measure);
    const double a = parameters[k].low * unit / start[static_cast<Eigen::Index>(k)];
    const double b = parameters[k].high * unit / start[static_cast<Eigen::Index>(k)];
    result.push_back({index, static_cast<int>(k), std::min(a, b), std::max(a, b)});
  }
  if (result.empty()) result.push_back({index, -1, 0, 1});
  return result;
}

}  // namespace

LinearProblem linearise(const Prepared& prepared, const std::vector<surefoot::AttachedEffect>& candidates,
                        const Parallel& parallel) {
  const BoundSimulator& bound = prepared.setup.bound;
  const FitProblem& problem = prepared.setup.problem;
  const Hypothesis& base = prepared.calibration.calibrated.hypothesis;
  const FitFunctions functions(bound, base, problem, parallel);
  const double limit = problem.weighting.robust;

  LinearProblem result;
  result.begin = functions.begin();
  const Eigen::VectorXd start = functions.start(), residuals = functions.residuals(start);
  result.residuals = residuals.unaryExpr([limit](double r) { return std::clamp(r, -limit, limit); });
  result.jacobian = functions.jacobian(start, residuals);
  for (const Proposal& proposal : propose(bound, base, problem, candidates, 0, parallel)) {
    if (!(proposal.visible > 0)) continue;  // has no signature that the parameters could not
    const auto more = unknowns_of(bound, proposal.effect, proposal.tried, result.candidates.size());
    result.unknowns.insert(result.unknowns.end(), more.begin(), more.end());
    result.candidates.push_back(proposal.effect);
    result.starts.push_back(proposal.tried);
  }
  result.columns = Eigen::MatrixXd::Zero(residuals.size(), static_cast<Eigen::Index>(result.unknowns.size()));
  const Parallel on_this_thread = serially();
  parallel(result.unknowns.size(), [&](std::size_t j) {
    const Unknown& unknown = result.unknowns[j];
    Hypothesis with = base;
    with.effects.push_back(result.candidates[unknown.candidate]);
    with.values.push_back(alone(with.effects.back(), result.starts[unknown.candidate], unknown.parameter));
    const FitFunctions changed(bound, with, problem, on_this_thread);
    const Eigen::VectorXd after = changed.residuals(changed.start());
    if (after.allFinite()) result.columns.col(static_cast<Eigen::Index>(j)) = after - residuals;
  });
  return result;
}

}  // namespace all_at_once

#include "choose.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "lasso.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"

using namespace surefoot::diagnosis;

namespace all_at_once {
namespace {

using Rows = std::vector<Eigen::Index>;
using Solver = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;

Rows rows_of(const LinearProblem& problem, const std::vector<std::size_t>& recordings) {
  Rows rows;
  for (const std::size_t i : recordings) {
    for (Eigen::Index row = problem.begin[i]; row < problem.begin[i + 1]; ++row) rows.push_back(row);
  }
  return rows;
}

// Some rows of the problem with the parameters solved for: what they could do is taken out of everything else.
struct Reduced {
  Lasso lasso;
  Eigen::VectorXd norms;             // of the columns that are left; unknown = z / norm
  Eigen::MatrixXd follow_columns;    // change of the parameters that best undoes a unit of each unknown
  Eigen::VectorXd follow_residuals;  // and the one that best removes the residuals
};

Reduced reduce(const LinearProblem& problem, const Rows& rows) {
  const Eigen::MatrixXd slopes = problem.jacobian(rows, Eigen::all);
  Eigen::MatrixXd columns = problem.columns(rows, Eigen::all);
  Eigen::VectorXd residuals = problem.residuals(rows);
  const Eigen::VectorXd whole = columns.colwise().norm();
  Reduced result;
  result.follow_columns = Eigen::MatrixXd::Zero(slopes.cols(), columns.cols());
  result.follow_residuals = Eigen::VectorXd::Zero(slopes.cols());
  if (slopes.cols() > 0) {
    const Solver solver(slopes);
    result.follow_columns = -solver.solve(columns);
    result.follow_residuals = -solver.solve(residuals);
    columns += slopes * result.follow_columns;
    residuals += slopes * result.follow_residuals;
  }
  const Eigen::Index count = columns.cols();
  result.norms = columns.colwise().norm();
  result.lasso.low.setZero(count);
  result.lasso.high.setZero(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const Unknown& unknown = problem.unknowns[static_cast<std::size_t>(j)];
    constexpr double least = 1e-2;  // share of a mark that the parameters must not be able to imitate
    if (!(result.norms[j] > least * whole[j]) || !(result.norms[j] > 0)) {
      columns.col(j).setZero();
      result.norms[j] = 1;
      continue;
    }
    columns.col(j) /= result.norms[j];
    result.lasso.low[j] = std::min(0.0, unknown.low * result.norms[j]);
    result.lasso.high[j] = std::max(0.0, unknown.high * result.norms[j]);
  }
  result.lasso.gram = columns.transpose() * columns;
  result.lasso.pull = -columns.transpose() * residuals;
  return result;
}

// Shares of the largest penalty, falling.
std::vector<double> penalty_path() {
  std::vector<double> shares;
  constexpr int count = 40;
  for (int i = 0; i < count; ++i) shares.push_back(std::pow(10.0, -3.0 * i / (count - 1)));
  return shares;
}

// Residuals of one recording that was not fitted. Slopes that are zero in the fitted rows belong to its own initial
// states, which are free here, too.
Eigen::VectorXd unseen(const LinearProblem& problem, std::size_t recording, const Reduced& fitted,
                       const Eigen::VectorXd& unknowns, const std::vector<Eigen::Index>& own) {
  const Eigen::Index from = problem.begin[recording], count = problem.begin[recording + 1] - from;
  Eigen::VectorXd left =
      problem.residuals.segment(from, count) + problem.columns.middleRows(from, count) * unknowns +
      problem.jacobian.middleRows(from, count) * (fitted.follow_residuals + fitted.follow_columns * unknowns);
  if (own.empty()) return left;
  const Eigen::MatrixXd slopes = problem.jacobian.middleRows(from, count)(Eigen::all, own);
  return left - slopes * Solver(slopes).solve(left);
}

std::vector<Eigen::Index> own_slopes(const LinearProblem& problem, const Rows& fitted, const Rows& held) {
  std::vector<Eigen::Index> own;
  for (Eigen::Index j = 0; j < problem.jacobian.cols(); ++j) {
    const Eigen::VectorXd slope = problem.jacobian.col(j);
    if (slope(fitted).cwiseAbs().maxCoeff() == 0 && slope(held).cwiseAbs().maxCoeff() > 0) own.push_back(j);
  }
  return own;
}

// Held-out losses of one fold, by penalty, added to `scores`.
void add_fold(const LinearProblem& problem, const std::vector<std::size_t>& fold, const std::vector<double>& penalties,
              double robust, std::vector<BlockLosses>& scores) {
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i + 1 < problem.begin.size(); ++i) {
    if (std::ranges::find(fold, i) == fold.end()) others.push_back(i);
  }
  const Rows fitted = rows_of(problem, others), held = rows_of(problem, fold);
  if (fitted.empty() || held.empty()) return;
  const Reduced reduced = reduce(problem, fitted);
  const std::vector<Eigen::Index> own = own_slopes(problem, fitted, held);
  // pulls of systematic errors grow with the root of the number of rows
  const double part = std::sqrt(static_cast<double>(fitted.size()) / static_cast<double>(problem.residuals.size()));
  Eigen::VectorXd z = Eigen::VectorXd::Zero(reduced.norms.size());
  for (std::size_t k = 0; k < penalties.size(); ++k) {
    z = solve(reduced.lasso, penalties[k] * part, z);
    const Eigen::VectorXd unknowns = z.cwiseQuotient(reduced.norms);
    for (const std::size_t i : fold) append_losses(scores[k], unseen(problem, i, reduced, unknowns, own), robust);
  }
}

// Index of the largest penalty that is within one standard error of the best.
std::size_t one_standard_error(const std::vector<BlockLosses>& scores) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < scores.size(); ++k) {
    if (scores[k].total() < scores[best].total()) best = k;
  }
  for (std::size_t k = 0; k < best; ++k) {
    const std::vector<double>&a = scores[k].blocks, &b = scores[best].blocks;
    const auto n = static_cast<double>(a.size());
    const double mean = (scores[k].total() - scores[best].total()) / n;
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i] - mean) * (a[i] - b[i] - mean);
    if (n > 1 && mean <= std::sqrt(squares / (n - 1) / n)) return k;
  }
  return best;
}

std::vector<Survivor> survivors_of(const LinearProblem& problem, const Reduced& reduced, const Eigen::VectorXd& z) {
  std::vector<Survivor> result;
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    Survivor survivor{c, problem.starts[c]};
    Eigen::VectorXd own = Eigen::VectorXd::Zero(z.size());
    for (std::size_t j = 0; j < problem.unknowns.size(); ++j) {
      const Unknown& unknown = problem.unknowns[j];
      if (unknown.candidate != c) continue;
      const auto k = static_cast<Eigen::Index>(j);
      own[k] = z[k];
      if (unknown.parameter >= 0) survivor.values[unknown.parameter] *= z[k] / reduced.norms[k];
    }
    survivor.energy = own.dot(reduced.lasso.gram * own);
    if (own.cwiseAbs().maxCoeff() > 0) result.push_back(survivor);
  }
  std::ranges::stable_sort(result, [](const Survivor& a, const Survivor& b) { return a.energy > b.energy; });
  return result;
}

}  // namespace

Choice choose(const LinearProblem& problem, const std::vector<std::vector<std::size_t>>& folds, double robust) {
  if (problem.unknowns.empty() || problem.residuals.size() == 0) return {};
  std::vector<std::size_t> all(problem.begin.size() - 1);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Reduced reduced = reduce(problem, rows_of(problem, all));
  const std::vector<double> shares = penalty_path();
  std::vector<double> penalties;
  for (const double share : shares) penalties.push_back(share * largest_penalty(reduced.lasso));

  // The largest penalty, and beside it nothing at all: folds may have larger pulls than the whole.
  penalties.insert(penalties.begin(), std::numeric_limits<double>::infinity());
  std::vector<BlockLosses> scores(penalties.size());
  for (const auto& fold : folds) add_fold(problem, fold, penalties, robust, scores);
  const std::size_t chosen = one_standard_error(scores);
  if (chosen == 0) return {{}, 1};
  Eigen::VectorXd z = Eigen::VectorXd::Zero(reduced.norms.size());
  for (std::size_t k = 0; k <= chosen; ++k) z = solve(reduced.lasso, penalties[k], z);
  return {survivors_of(problem, reduced, z), shares[chosen - 1]};
}

}  // namespace all_at_once

#include "regression.hpp"

#include <algorithm>
#include <cmath>

namespace sparse {
namespace {

using plants::Column;
using plants::Values;

// Least squares over the active columns, by Cholesky's decomposition with a trace of ridge.
Values least_squares(const std::vector<Values>& gram, const Values& right, const std::vector<std::size_t>& active) {
  const std::size_t n = active.size();
  std::vector<Values> lower(n, Values(n));
  Values solution(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = gram[active[i]][active[j]] * (i == j ? 1 + 1e-9 : 1);
      for (std::size_t k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      lower[i][j] = i == j ? std::sqrt(std::max(sum, 1e-12)) : sum / lower[j][j];
    }
  for (std::size_t i = 0; i < n; ++i) {
    double sum = right[active[i]];
    for (std::size_t k = 0; k < i; ++k) sum -= lower[i][k] * solution[k];
    solution[i] = sum / lower[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) solution[i] -= lower[k][i] * solution[k];
    solution[i] /= lower[i][i];
  }
  return solution;
}

double dot(const Column& a, const Column& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double error(const Rows& rows, const Values& coefficients) {
  double sum = 0;
  for (std::size_t r = 0; r < rows.target.size(); ++r) {
    double left = rows.target[r];
    for (std::size_t c = 0; c < coefficients.size(); ++c) left -= coefficients[c] * rows.columns[c][r];
    sum += left * left;
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(rows.target.size(), 1)));
}

}  // namespace

Fit regress(const Rows& rows, const Rows& check) {
  const std::size_t count = rows.columns.size();
  const double scale = std::sqrt(std::max(dot(rows.target, rows.target), 1e-300));
  Values norms(count, 1);  // of the columns, so that a coefficient is a share of the residual
  for (std::size_t c = 0; c < count; ++c)
    norms[c] = std::sqrt(std::max(dot(rows.columns[c], rows.columns[c]), 1e-300)) / scale;
  std::vector<Values> gram(count, Values(count));
  Values right(count);
  for (std::size_t i = 0; i < count; ++i) {
    right[i] = dot(rows.columns[i], rows.target) / norms[i] / (scale * scale);
    for (std::size_t j = 0; j < count; ++j)
      gram[i][j] = dot(rows.columns[i], rows.columns[j]) / norms[i] / norms[j] / (scale * scale);
  }

  const auto fit_with = [&](double threshold) {
    std::vector<std::size_t> active;
    for (std::size_t c = 0; c < count; ++c)
      if (c < rows.kept || threshold < 1e9) active.push_back(c);
    Values solution = least_squares(gram, right, active);
    for (int round = 0; round < 20; ++round) {
      std::vector<std::size_t> remaining;
      for (std::size_t i = 0; i < active.size(); ++i)
        if (active[i] < rows.kept || std::abs(solution[i]) >= threshold) remaining.push_back(active[i]);
      if (remaining == active) break;
      active = remaining;
      solution = least_squares(gram, right, active);
    }
    Values coefficients(count, 0);
    for (std::size_t i = 0; i < active.size(); ++i) coefficients[active[i]] = solution[i] / norms[active[i]];
    return coefficients;
  };

  Fit best;
  best.coefficients = fit_with(1e10);
  best.before = best.after = error(check, best.coefficients);
  double least = best.after;
  for (const double threshold : {0.8, 0.6, 0.45, 0.3, 0.2, 0.15, 0.1}) {  // sparse first
    const Values coefficients = fit_with(threshold);
    const double after = error(check, coefficients);
    if (after > 0.98 * least) continue;
    least = after;
    best.coefficients = coefficients;
    best.threshold = threshold;
    best.after = after;
  }
  return best;
}

}  // namespace sparse

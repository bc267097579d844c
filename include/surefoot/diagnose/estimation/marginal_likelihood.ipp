// Definitions of surefoot/diagnose/estimation/marginal_likelihood.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/marginal_likelihood.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE double ErrorSquares::rms() const {
  double sum = 0, count = 0;
  for (Eigen::Index i = 0; i < counts.size(); ++i) {
    sum += mean_squares.data()[i] * counts.data()[i];
    count += counts.data()[i];
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

SUREFOOT_INLINE double autocorrelation_time(const std::vector<Eigen::VectorXd>& series) {
  constexpr Eigen::Index most_lags = 2000;  // longer correlations are not told apart
  double squares = 0;
  Eigen::Index longest = 0;
  for (const Eigen::VectorXd& one : series) {
    squares += surefoot::detail::sum_of_squares(one);
    longest = std::max(longest, one.size());
  }
  if (!(squares > 0)) return 1;
  double count = 0;
  for (const Eigen::VectorXd& one : series) count += static_cast<double>(one.size());
  double slow = 1, oscillating = 1;
  bool positive = true;
  const Eigen::Index last = std::min(most_lags, longest / 2);
  for (Eigen::Index lag = 1; lag + 1 < last; lag += 2) {
    double pair = 0, squared = 0;
    for (Eigen::Index k = lag; k < lag + 2; ++k) {
      double sum = 0;
      for (const Eigen::VectorXd& one : series) {
        if (one.size() > k) sum += surefoot::detail::dot(one.data(), one.data() + k, one.size() - k);
      }
      const double correlation = sum / squares;
      pair += correlation;
      squared += correlation * correlation - 1 / count;  // what chance alone gives
    }
    positive = positive && pair > 0;
    if (positive) slow += 2 * pair;
    oscillating += 2 * squared;
  }
  return std::max({1.0, slow, oscillating});
}

/// Errors of one recording in units of the scale; infinite if its simulation ran away.
SUREFOOT_INLINE Eigen::VectorXd scaled_errors(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t r,
                                              const Integration& integration, const Weighting& scale,
                                              const std::vector<Cell>& cells) {
  return weighted_residuals(bound, r, simulate(bound, hypothesis, r, integration), cells, scale);
}

SUREFOOT_INLINE ErrorSquares error_squares(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                           const std::vector<std::size_t>& recordings, const Integration& integration,
                                           const Weighting& scale, const Parallel& parallel) {
  constexpr double ran_away = 1e12;  // mean square of a simulation that ran away: much, but finite
  const auto rows = static_cast<Eigen::Index>(recordings.size());
  const auto outputs = static_cast<Eigen::Index>(bound.info.outputs.size());
  ErrorSquares result{Eigen::MatrixXd::Zero(rows, outputs), Eigen::MatrixXd::Zero(rows, outputs),
                      Eigen::VectorXd::Ones(outputs)};
  std::vector<std::vector<Eigen::VectorXd>> series(recordings.size());
  parallel(recordings.size(), [&](std::size_t i) {
    const auto row = static_cast<Eigen::Index>(i);
    const std::vector<Cell> cells = cells_of(bound.recordings[recordings[i]]);
    const Eigen::VectorXd off = scaled_errors(bound, hypothesis, recordings[i], integration, scale, cells);
    std::vector<std::vector<double>> values(static_cast<std::size_t>(outputs));
    for (std::size_t c = 0; c < cells.size(); ++c) {
      values[static_cast<std::size_t>(cells[c].output)].push_back(off[static_cast<Eigen::Index>(c)]);
    }
    for (Eigen::Index k = 0; k < outputs; ++k) {
      const auto& own = values[static_cast<std::size_t>(k)];
      Eigen::VectorXd one(static_cast<Eigen::Index>(own.size()));
      std::copy(own.begin(), own.end(), one.data());
      const double squares = surefoot::detail::sum_of_squares(one);
      result.counts(row, k) = static_cast<double>(own.size());
      const bool finite = std::isfinite(squares);
      if (!own.empty()) {
        result.mean_squares(row, k) = finite ? std::min(ran_away, squares / static_cast<double>(own.size())) : ran_away;
      }
      series[i].push_back(finite ? one : Eigen::VectorXd());
    }
  });
  for (Eigen::Index k = 0; k < outputs; ++k) {
    std::vector<Eigen::VectorXd> of_output;
    for (const auto& one : series) of_output.push_back(one[static_cast<std::size_t>(k)]);
    result.memory[k] = autocorrelation_time(of_output);
  }
  return result;
}

/// A part of the Jacobian with its rows weighted.
SUREFOOT_ONCE Eigen::MatrixXd weighted_columns(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& weight,
                                               Eigen::Index from, const std::vector<Eigen::Index>& columns) {
  Eigen::MatrixXd part(weight.size(), static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index k = 0; k < part.cols(); ++k) {
    const double* column = jacobian.data() + columns[static_cast<std::size_t>(k)] * jacobian.rows() + from;
    for (Eigen::Index i = 0; i < part.rows(); ++i) part(i, k) = weight[i] * column[i];
  }
  return part;
}

SUREFOOT_ONCE void subtract(Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i) a.data()[i] -= b.data()[i];
}

/// Places among the variables of a fit: of those that all recordings share, and of the initial state of each.
struct VariablePlaces {
  std::vector<Eigen::Index> shared;
  std::vector<std::vector<Eigen::Index>> own;  // by recording of the problem
};

SUREFOOT_ONCE VariablePlaces places_of(const std::vector<Variable>& variables,
                                       const std::vector<std::size_t>& recordings) {
  VariablePlaces places{{}, std::vector<std::vector<Eigen::Index>>(recordings.size())};
  for (std::size_t v = 0; v < variables.size(); ++v) {
    const bool initial = is_of_one_recording(variables[v]);
    if (!initial) places.shared.push_back(static_cast<Eigen::Index>(v));
    for (std::size_t i = 0; i < recordings.size() && initial; ++i) {
      if (recordings[i] == variables[v].item) places.own[i].push_back(static_cast<Eigen::Index>(v));
    }
  }
  return places;
}

SUREFOOT_ONCE Eigen::MatrixXd information(const FitFunctions& functions, const Eigen::VectorXd& z,
                                          const FitProblem& problem, double least_variance,
                                          const VariablePlaces& places) {
  using surefoot::detail::invert_symmetric, surefoot::detail::product, surefoot::detail::transposed_product;
  constexpr double ridge = 1e-9;  // of the diagonal: what nothing determines stays where it is
  const Eigen::VectorXd residuals = functions.residuals(z);
  const Eigen::MatrixXd jacobian = functions.jacobian(z, residuals);
  const auto count = static_cast<Eigen::Index>(places.shared.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(count, count);
  std::vector<Eigen::VectorXd> series;
  double squares = 0;
  for (std::size_t i = 0; i < problem.recordings.size(); ++i) {
    const Eigen::Index from = functions.begin()[i], length = functions.begin()[i + 1] - from;
    Eigen::VectorXd weight(length), off(length);
    for (Eigen::Index n = 0; n < length; ++n) {
      const double r = residuals[from + n], far = std::abs(r) / problem.weighting.robust;
      weight[n] = !std::isfinite(r) ? 0 : far > 1 ? std::sqrt(1 / far) : 1;
      off[n] = std::isfinite(r) ? weight[n] * r : 0;
    }
    squares += surefoot::detail::sum_of_squares(off);
    series.push_back(off);
    const Eigen::MatrixXd js = weighted_columns(jacobian, weight, from, places.shared);
    Eigen::MatrixXd own = transposed_product(js, js);
    if (!places.own[i].empty()) {
      const Eigen::MatrixXd ji = weighted_columns(jacobian, weight, from, places.own[i]);
      Eigen::MatrixXd of_initial = transposed_product(ji, ji);
      for (Eigen::Index k = 0; k < of_initial.rows(); ++k) of_initial(k, k) += ridge * (1 + of_initial(k, k));
      const Eigen::MatrixXd across = transposed_product(ji, js);
      subtract(own, transposed_product(across, product(invert_symmetric(of_initial), across)));
    }
    for (Eigen::Index k = 0; k < sum.size(); ++k) sum.data()[k] += own.data()[k];
  }
  const double variance = squares / static_cast<double>(std::max<Eigen::Index>(1, residuals.size()));
  const double memory = autocorrelation_time(series);
  const double unit = std::max({variance, least_variance, std::numeric_limits<double>::min()}) * memory;
  for (Eigen::Index k = 0; k < sum.size(); ++k) sum.data()[k] /= unit;
  return sum;
}

SUREFOOT_ONCE double prior_width(const Variable& variable, double value) {
  constexpr double smallest = 0.01;  // of the largest size: below, an effect is none
  const double low = to_search(variable, variable.low), high = to_search(variable, variable.high);
  const double uniform = 0.5 * (high - low);
  if (variable.kind != Variable::Kind::effect || variable.logarithmic || variable.low > 0 || variable.high <= 0) {
    return uniform;
  }
  const double largest = std::max(std::abs(low), high);
  const double width = 0.5 * (std::abs(to_search(variable, value)) + smallest * largest) * std::log1p(1 / smallest);
  return std::min(uniform, variable.low < 0 ? 2 * width : width);
}

SUREFOOT_ONCE double log_occam_factor(const BoundSimulator& bound, const Hypothesis& fitted, const FitProblem& problem,
                                      double least_variance, const Parallel& parallel) {
  const FitFunctions functions(bound, fitted, problem, parallel);
  const VariablePlaces places = places_of(functions.variables(), problem.recordings);
  const auto count = static_cast<Eigen::Index>(places.shared.size());
  if (count == 0) return 0;
  Eigen::MatrixXd determined = information(functions, functions.start(), problem, least_variance, places);
  Hypothesis copy = fitted;
  Eigen::VectorXd width(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto place = static_cast<std::size_t>(places.shared[static_cast<std::size_t>(k)]);
    const Variable& variable = functions.variables()[place];
    width[k] = prior_width(variable, value_of(copy, variable));
  }
  determined = surefoot::detail::scaled(width, determined);
  for (Eigen::Index k = 0; k < count; ++k) determined(k, k) += 1;
  if (!surefoot::detail::factorise_in_place(determined)) return 0;
  double sum = 0;
  for (Eigen::Index k = 0; k < count; ++k) sum -= std::log(determined(k, k));  // half the log of the determinant
  return sum;
}

}  // namespace surefoot::diagnosis

#include "linear_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace diagnose_robot {
namespace {

constexpr double fewest_independent = 4;   // errors of a joint, however slowly they change
constexpr double smallest_square = 1e-24;  // errors of nothing have no logarithm
constexpr int bound_changes = 60;          // of the active set
constexpr Eigen::Index most_lags = 600;    // longer correlations are not told apart

using Places = std::vector<Eigen::Index>;

Eigen::VectorXd picked(const Eigen::VectorXd& vector, const Places& places) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(places.size()));
  for (Eigen::Index i = 0; i < result.size(); ++i) result[i] = vector[places[static_cast<std::size_t>(i)]];
  return result;
}

Eigen::MatrixXd picked_both_ways(const Eigen::MatrixXd& matrix, const Places& places) {
  const auto count = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd result(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      result(i, j) = matrix(places[static_cast<std::size_t>(i)], places[static_cast<std::size_t>(j)]);
    }
  }
  return result;
}

void put(const Eigen::VectorXd& values, const Places& places, Eigen::VectorXd& vector) {
  for (Eigen::Index i = 0; i < values.size(); ++i) vector[places[static_cast<std::size_t>(i)]] = values[i];
}

// Sums of the terms `of` alone, with or without a block.
Sums part(const LinearModel& model, std::size_t joint, const std::vector<Eigen::Index>& of, int without_block) {
  const Sums& whole = model.whole[joint];
  Sums sums{picked_both_ways(whole.gram, of), picked(whole.slope, of), whole.square, whole.rows};
  if (without_block < 0) return sums;
  const Sums& block = model.sums[joint][static_cast<std::size_t>(without_block)];
  sums.gram -= picked_both_ways(block.gram, of);
  sums.slope -= picked(block.slope, of);
  sums.square -= block.square;
  sums.rows -= block.rows;
  return sums;
}

Eigen::VectorXd pooled(const LinearModel& model, const std::vector<Sums>& joints, const Eigen::VectorXd& square) {
  Eigen::VectorXd rows(square.size());
  for (Eigen::Index j = 0; j < rows.size(); ++j) rows[j] = joints[static_cast<std::size_t>(j)].rows;
  return mean_squares(model, square, rows);
}

// Errors of joints, weighted by their independent count over their size, and the prior: the quadratic that lies above
// Cauchy's density and touches it at `now`, which are values of the terms `of`.
void normal_equations(const LinearModel& model, const std::vector<Sums>& joints, const std::vector<Eigen::Index>& of,
                      const Eigen::VectorXd& square, const Eigen::VectorXd& now, Eigen::MatrixXd& q,
                      Eigen::VectorXd& c) {
  const Eigen::VectorXd size = pooled(model, joints, square);
  const auto terms = static_cast<Eigen::Index>(of.size());
  q = Eigen::MatrixXd::Zero(terms, terms);
  c = Eigen::VectorXd::Zero(terms);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    const double weight = model.independent[at] / (size[at] * std::max(1.0, joints[j].rows));
    q += weight * joints[j].gram;
    c += weight * joints[j].slope;
  }
  for (Eigen::Index i = 0; i < terms; ++i) {
    const Eigen::Index t = of[static_cast<std::size_t>(i)];
    const double share = now[i] / model.prior[t];
    const double precision = 2 / (model.prior[t] * model.prior[t] * (1 + share * share));
    q(i, i) += precision;
    c[i] += precision * model.theta[t];
  }
}

std::vector<Eigen::Index> members(const TermSet& set) {
  std::vector<Eigen::Index> result;
  for (std::size_t t = 0; t < set.size(); ++t) {
    if (set[t] != 0) result.push_back(static_cast<Eigen::Index>(t));
  }
  return result;
}

}  // namespace

double prior_cost(const LinearModel& model, Eigen::Index term, double size) {
  const double share = size / model.prior[term];
  return 2 * std::log1p(share * share);
}

Eigen::VectorXd independent_after(const LinearModel& model, const TermSet& set) {
  Eigen::VectorXd result = model.independent;
  if (model.columns.empty()) return result;
  TermSet all = set;
  for (std::size_t t = 0; t < all.size(); ++t) all[t] = set[t] != 0 || model.of_groups[t] != 0 ? 1 : 0;
  const Eigen::VectorXd change = fit_linear(model, all).change;
  const int pools = 1 + *std::ranges::max_element(model.pool);
  for (int p = 0; p < pools; ++p) {
    std::vector<Eigen::VectorXd> series;
    for (std::size_t j = 0; j < model.pool.size(); ++j) {
      if (model.pool[j] == p) series.emplace_back(model.errors[j] + model.columns[j] * change(model.terms[j]));
    }
    const double time = correlation_time(series);
    for (std::size_t j = 0; j < model.pool.size(); ++j) {
      if (model.pool[j] != p) continue;
      const auto rows = static_cast<double>(model.errors[j].array().isFinite().count());
      result[static_cast<Eigen::Index>(j)] = std::max(fewest_independent, rows / time);
    }
  }
  return result;
}

// Those of joints of a pool, by the count of independent errors.
Eigen::VectorXd mean_squares(const LinearModel& model, const Eigen::VectorXd& square, const Eigen::VectorXd& rows) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(square.size()), count = sum, result = sum;
  for (Eigen::Index j = 0; j < square.size(); ++j) {
    const int p = model.pool[static_cast<std::size_t>(j)];
    sum[p] += model.independent[j] * square[j] / std::max(1.0, rows[j]);
    count[p] += model.independent[j];
  }
  for (Eigen::Index j = 0; j < square.size(); ++j) {
    const int p = model.pool[static_cast<std::size_t>(j)];
    result[j] = std::max(smallest_square, sum[p] / count[p]);
  }
  return result;
}

Eigen::VectorXd pooled_squares(const LinearModel& model, const Eigen::VectorXd& square) {
  return pooled(model, model.whole, square);
}

double square_after(const Sums& sums, const Eigen::VectorXd& change) {
  // Of some hundred terms few are there: the others cost nothing.
  std::vector<Eigen::Index> there;
  for (Eigen::Index t = 0; t < change.size(); ++t) {
    if (change[t] != 0) there.push_back(t);
  }
  double sum = sums.square;
  for (const Eigen::Index t : there) {
    double row = 2 * sums.slope[t];
    for (const Eigen::Index other : there) row += sums.gram(other, t) * change[other];
    sum += change[t] * row;
  }
  return sum;
}

Eigen::VectorXd bounded_minimum(const Eigen::MatrixXd& q, const Eigen::VectorXd& c, const Eigen::VectorXd& low,
                                const Eigen::VectorXd& high) {
  const Eigen::Index n = c.size();
  const Eigen::VectorXd scale = q.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * q * scale.asDiagonal();
  std::vector<int> side(static_cast<std::size_t>(n), 0);  // at its low or high bound, or free
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (int change = 0; change < bound_changes; ++change) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < n; ++i) {
      const int s = side[static_cast<std::size_t>(i)];
      if (s == 0) free.push_back(i);
      x[i] = s < 0 ? low[i] : s > 0 ? high[i] : 0;
    }
    const Eigen::VectorXd gradient = c + q * x;
    if (!free.empty()) {
      const Eigen::VectorXd downhill = picked(-scale.cwiseProduct(gradient), free);
      const Eigen::VectorXd step = picked_both_ways(scaled, free).ldlt().solve(downhill);
      for (std::size_t i = 0; i < free.size(); ++i) x[free[i]] = scale[free[i]] * step[static_cast<Eigen::Index>(i)];
    }
    Eigen::Index worst = -1;
    double beyond = 0;
    for (const Eigen::Index i : free) {
      const double over = std::max(low[i] - x[i], x[i] - high[i]) / scale[i];
      if (over > beyond) {
        beyond = over;
        worst = i;
      }
    }
    if (worst >= 0) {
      side[static_cast<std::size_t>(worst)] = x[worst] < low[worst] ? -1 : 1;
      continue;
    }
    const Eigen::VectorXd end = c + q * x;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double inward = -end[i] * side[static_cast<std::size_t>(i)] * scale[i];
      if (side[static_cast<std::size_t>(i)] != 0 && -inward > 1e-9 && -inward > beyond) {
        beyond = -inward;
        worst = i;
      }
    }
    if (worst < 0) break;
    side[static_cast<std::size_t>(worst)] = 0;
  }
  return x.cwiseMax(low).cwiseMin(high);
}

void add_up(LinearModel& model) {
  model.whole.clear();
  for (const std::vector<Sums>& blocks : model.sums) {
    Sums sum = blocks.front();
    for (std::size_t b = 1; b < blocks.size(); ++b) {
      sum.gram += blocks[b].gram;
      sum.slope += blocks[b].slope;
      sum.square += blocks[b].square;
      sum.rows += blocks[b].rows;
    }
    model.whole.push_back(std::move(sum));
  }
}

LinearFit fit_linear(const LinearModel& model, const TermSet& set, int without_block) {
  const auto joints = model.sums.size();
  // Terms that can change: those of the set, and others that are not 0 yet.
  std::vector<Eigen::Index> of, in;  // in: places in `of` of the set's
  for (std::size_t t = 0; t < set.size(); ++t) {
    if (set[t] != 0) in.push_back(static_cast<Eigen::Index>(of.size()));
    if (set[t] != 0 || model.theta[static_cast<Eigen::Index>(t)] != 0) of.push_back(static_cast<Eigen::Index>(t));
  }
  std::vector<Sums> by_joint;
  LinearFit fit;
  fit.square.resize(static_cast<Eigen::Index>(joints));
  for (std::size_t j = 0; j < joints; ++j) {
    by_joint.push_back(part(model, j, of, without_block));
    fit.square[static_cast<Eigen::Index>(j)] = by_joint[j].square;
  }
  const Eigen::VectorXd theta = picked(model.theta, of);
  const Eigen::VectorXd low = picked(model.low, of) - theta, high = picked(model.high, of) - theta;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(theta.size());
  // Weights follow what is left, and priors the sizes, until errors hardly change: a large effect begins small, since
  // what it has not yet explained counts as noise.
  constexpr int most_reweightings = 20;
  constexpr double settled = 0.01;  // of a mean square error: far less than any criterion sees
  for (int again = 0; again < most_reweightings; ++again) {
    const Eigen::VectorXd before = fit.square;
    Eigen::MatrixXd q;
    Eigen::VectorXd c;
    normal_equations(model, by_joint, of, fit.square, theta + change, q, c);
    change = -theta;
    put(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(in.size())), in, change);
    if (!in.empty()) {
      const Eigen::VectorXd here = picked(c + q * change, in);
      put(bounded_minimum(picked_both_ways(q, in), here, picked(low, in), picked(high, in)), in, change);
    }
    for (std::size_t j = 0; j < joints; ++j) {
      fit.square[static_cast<Eigen::Index>(j)] = std::max(smallest_square, square_after(by_joint[j], change));
    }
    if (again > 0 && ((fit.square - before).array().abs() <= settled * before.array()).all()) break;
  }
  fit.change = Eigen::VectorXd::Zero(model.theta.size());
  put(change, of, fit.change);
  const Eigen::VectorXd mean = pooled(model, by_joint, fit.square);
  fit.criterion = model.independent.dot(mean.array().log().matrix());
  for (const Eigen::Index t : members(set)) {
    fit.criterion += model.cost[t] + prior_cost(model, t, model.theta[t] + fit.change[t]);
  }
  return fit;
}

Eigen::VectorXd standard_errors(const LinearModel& model, const TermSet& set) {
  const std::vector<Eigen::Index> in = members(set);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(model.theta.size());
  if (in.empty()) return result;
  std::vector<Sums> by_joint;
  Eigen::VectorXd square(static_cast<Eigen::Index>(model.whole.size()));
  for (std::size_t j = 0; j < model.whole.size(); ++j) {
    by_joint.push_back(part(model, j, in, -1));
    square[static_cast<Eigen::Index>(j)] = by_joint[j].square;
  }
  Eigen::MatrixXd q;
  Eigen::VectorXd c;
  normal_equations(model, by_joint, in, square, picked(model.theta, in), q, c);
  const Eigen::VectorXd scale = q.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * q * scale.asDiagonal();
  const Eigen::MatrixXd inverse = scaled.ldlt().solve(Eigen::MatrixXd::Identity(scaled.rows(), scaled.cols()));
  for (std::size_t i = 0; i < in.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    result[in[i]] = scale[at] * std::sqrt(std::max(0.0, inverse(at, at)));
  }
  return result;
}

double correlation_time(const std::vector<Eigen::VectorXd>& series) {
  std::vector<Eigen::VectorXd> known;  // of size 1
  double rows = 0;
  for (const Eigen::VectorXd& one : series) {
    const Eigen::VectorXd finite = one.unaryExpr([](double e) { return std::isfinite(e) ? e : 0.0; });
    if (finite.isZero(0)) continue;
    known.push_back(finite.normalized());
    rows += static_cast<double>(one.array().isFinite().count());
  }
  if (known.empty()) return 1;
  const auto correlation = [&](Eigen::Index lag) {
    double sum = 0;
    for (const Eigen::VectorXd& one : known) {
      if (one.size() > lag) sum += one.head(one.size() - lag).dot(one.tail(one.size() - lag));
    }
    return sum / static_cast<double>(known.size());
  };
  double slow = 1, oscillating = 1;
  bool positive = true;
  const Eigen::Index last = std::min(most_lags, known.front().size() / 2);
  for (Eigen::Index lag = 1; lag + 1 < last; lag += 2) {
    const double one = correlation(lag), other = correlation(lag + 1);
    positive = positive && one + other > 0;
    if (positive) slow += 2 * (one + other);
    oscillating += 2 * (one * one + other * other - 2 / rows);  // less what chance alone gives
  }
  return std::max({1.0, slow, oscillating});
}

double independent_errors(const Eigen::Ref<const Eigen::VectorXd>& errors) {
  const auto rows = static_cast<double>(errors.array().isFinite().count());
  return std::max(fewest_independent, rows / correlation_time(std::vector<Eigen::VectorXd>{Eigen::VectorXd(errors)}));
}

}  // namespace diagnose_robot

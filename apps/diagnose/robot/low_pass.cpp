#include "low_pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace diagnose_robot {
namespace {

double variance(const Eigen::Ref<const Eigen::VectorXd>& x) {
  double sum = 0, square = 0, rows = 0;
  for (const double value : x) {
    if (!std::isfinite(value)) continue;
    sum += value;
    square += value * value;
    rows += 1;
  }
  return rows > 0 ? square / rows - (sum / rows) * (sum / rows) : 0;
}

}  // namespace

LowPass low_pass(const Eigen::VectorXd& time, double width, const Eigen::Ref<const Eigen::VectorXd>& torque) {
  const Eigen::Index rows = torque.size();
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index first = 0;
  for (Eigen::Index k = 0; k < rows; ++k) {
    if (!std::isfinite(torque[k])) continue;
    while (time[k] - time[first] > width) ++first;
    const std::size_t begin = entries.size();
    double sum = 0;
    for (Eigen::Index i = first; i < rows && time[i] - time[k] <= width; ++i) {
      if (!std::isfinite(torque[i])) continue;
      const double x = i == k ? 0 : std::abs(time[i] - time[k]) / width;
      const double weight = std::pow(1 - x * x * x, 3);  // tricube
      entries.emplace_back(k, i, weight);
      sum += weight;
    }
    for (std::size_t e = begin; e < entries.size(); ++e)
      entries[e] = {entries[e].row(), entries[e].col(), entries[e].value() / sum};
  }
  LowPass filter(rows, rows);
  filter.setFromTriplets(entries.begin(), entries.end());
  return filter;
}

Eigen::VectorXd low_passed(const Eigen::VectorXd& time, double width, const Eigen::Ref<const Eigen::VectorXd>& torque) {
  const Eigen::VectorXd known = torque.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
  Eigen::VectorXd filtered = low_pass(time, width, torque) * known;
  for (Eigen::Index k = 0; k < filtered.size(); ++k) {
    if (!std::isfinite(torque[k])) filtered[k] = std::numeric_limits<double>::quiet_NaN();
  }
  return filtered;
}

Eigen::MatrixXd low_passed(const Motion& motion, Eigen::MatrixXd torques) {
  for (Eigen::Index j = 0; j < torques.cols(); ++j)
    torques.col(j) = low_passed(motion.time, motion.low_pass[j], torques.col(j));
  return torques;
}

double low_pass_width(const Eigen::VectorXd& time, const Eigen::Ref<const Eigen::VectorXd>& torque,
                      const std::function<double(double)>& noise_share, const LowPassCriteria& criteria) {
  const double least = criteria.kept * variance(torque);
  double accepted = 0;
  for (double width = criteria.narrowest; noise_share(accepted) > criteria.noise && width < criteria.widest;
       width *= criteria.wider) {
    if (variance(low_passed(time, width, torque)) < least) break;
    accepted = width;
  }
  return accepted;
}

}  // namespace diagnose_robot

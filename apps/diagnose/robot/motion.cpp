#include "motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace diagnose_robot {
namespace {

// One row: value, first and second derivative of the cubic that fits the window best, with tricube weights.
void smooth_row(const RobotRecording& r, Eigen::Index k, double reach, Eigen::Index fewest, Motion& motion) {
  const Eigen::Index rows = r.time.size();
  Eigen::Index first = k, last = k;
  while (first > 0 && (r.time[k] - r.time[first - 1] <= reach || k - first < fewest)) --first;
  while (last + 1 < rows && (r.time[last + 1] - r.time[k] <= reach || last - k < fewest)) ++last;
  const double scale = std::max(r.time[last] - r.time[k], r.time[k] - r.time[first]) * 1.001;
  const Eigen::Index count = last - first + 1;
  Eigen::Matrix<double, Eigen::Dynamic, 4> basis(count, 4);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double x = (r.time[first + i] - r.time[k]) / scale;
    const double w = std::pow(1 - std::pow(std::abs(x), 3), 3);
    basis.row(i) << w, w * x, w * x * x, w * x * x * x;
  }
  // Weights twice: once in the basis, once more with the readings.
  const Eigen::Matrix4d gram = basis.transpose() * basis;
  Eigen::Matrix<double, 4, Eigen::Dynamic> filter = gram.ldlt().solve(basis.transpose());
  for (Eigen::Index i = 0; i < count; ++i) filter.col(i) *= basis(i, 0);
  const auto block = r.angle.middleRows(first, count);
  motion.q.row(k) = filter.row(0) * block;
  motion.v.row(k) = filter.row(1) * block / scale;
  motion.a.row(k) = 2 * filter.row(2) * block / (scale * scale);
  if (r.goal.size() > 0) motion.goal.row(k) = filter.row(0) * r.goal.middleRows(first, count);
  if (r.torque.size() > 0) motion.torque.row(k) = filter.row(0) * r.torque.middleRows(first, count);
}

}  // namespace

Motion smooth(const RobotRecording& recording, const MotionCriteria& criteria) {
  Motion motion;
  const Eigen::Index rows = recording.angle.rows(), joints = recording.angle.cols();
  for (Eigen::MatrixXd* matrix : {&motion.q, &motion.v, &motion.a}) matrix->resize(rows, joints);
  if (recording.goal.size() > 0) motion.goal.resize(rows, joints);
  if (recording.torque.size() > 0) motion.torque.resize(rows, joints);
  const double reach =
      std::max(criteria.half_window, static_cast<double>(criteria.fewest_rows) * recording.row_period());
  for (Eigen::Index k = 0; k < rows; ++k) smooth_row(recording, k, reach, criteria.fewest_rows, motion);
  return motion;
}

}  // namespace diagnose_robot

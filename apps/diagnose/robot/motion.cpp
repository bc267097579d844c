#include "motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "low_pass.hpp"
#include "surefoot/core/rng.hpp"

namespace diagnose_robot {
namespace {

using Weights = std::vector<Eigen::Triplet<double>>;

// The means of true accelerations that the filter of a row makes of angles: its kernel of Peano, at the rows.
void add_means(const RobotRecording& r, Eigen::Index k, Eigen::Index first, const Eigen::RowVectorXd& filter,
               Weights& means) {
  const Eigen::Index count = filter.size();
  Eigen::VectorXd kernel = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 1; i + 1 < count; ++i) {
    for (Eigen::Index later = i + 1; later < count; ++later)
      kernel[i] += filter[later] * (r.time[first + later] - r.time[first + i]);
    kernel[i] *= r.time[first + i + 1] - r.time[first + i - 1];
  }
  const double sum = kernel.sum();
  for (Eigen::Index i = 1; i + 1 < count; ++i) means.emplace_back(k, first + i, kernel[i] / sum);
}

// One row: value, first and second derivative of the cubic that fits the window best, with tricube weights.
void smooth_row(const RobotRecording& r, Eigen::Index k, double reach, Eigen::Index fewest, Motion& motion,
                Weights& means) {
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
  if (k == 0) motion.start_gain = filter.row(1).norm() / scale;
  motion.a.row(k) = 2 * filter.row(2) * block / (scale * scale);
  if (r.goal.size() > 0) motion.goal.row(k) = filter.row(0) * r.goal.middleRows(first, count);
  if (r.torque.size() == 0) return;
  motion.torque.row(k) = filter.row(0) * r.torque.middleRows(first, count);
  add_means(r, k, first, filter.row(2), means);
}

Motion smooth_with(const RobotRecording& recording, double half_window, Eigen::Index fewest) {
  Motion motion;
  const Eigen::Index rows = recording.angle.rows(), joints = recording.angle.cols();
  for (Eigen::MatrixXd* matrix : {&motion.q, &motion.v, &motion.a}) matrix->resize(rows, joints);
  if (recording.goal.size() > 0) motion.goal.resize(rows, joints);
  if (recording.torque.size() > 0) motion.torque.resize(rows, joints);
  const double reach = std::max(half_window, static_cast<double>(fewest) * recording.row_period());
  Weights weights;
  for (Eigen::Index k = 0; k < rows; ++k) smooth_row(recording, k, reach, fewest, motion, weights);
  if (recording.torque.size() > 0) {
    // Angles, speeds and torques lose next to nothing in the filter, accelerations what goes with the square of its
    // window: twicing (Tukey) gives it back.
    Eigen::SparseMatrix<double, Eigen::RowMajor> means(rows, rows);
    means.setFromTriplets(weights.begin(), weights.end());
    motion.a = 2 * motion.a - means * motion.a;
  }
  motion.torque_late = recording.torque_late;
  motion.half_window = half_window;
  motion.reach = reach;
  motion.time = recording.time;
  while (motion.edge < std::min(rows / 4, fewest) ||
         (motion.edge < rows / 4 && recording.time[motion.edge] - recording.time[0] < reach))
    ++motion.edge;
  return motion;
}

// Root mean square behind the low-pass filter, of rows that windows lie around.
double low_passed_rms(const Motion& motion, double width, const Eigen::Ref<const Eigen::VectorXd>& x) {
  const Eigen::Index rows = x.size() - 2 * motion.edge;
  const Eigen::VectorXd filtered =
      low_passed(motion.time.segment(motion.edge, rows), width, x.segment(motion.edge, rows));
  return std::sqrt(filtered.squaredNorm() / static_cast<double>(rows));
}

// White noise of size 1 through the filter of angles.
Motion smooth_noise(const RobotRecording& recording, double half_window, Eigen::Index fewest) {
  RobotRecording noise;
  noise.time = recording.time;
  noise.angle.resize(recording.time.size(), 1);
  if (recording.torque.size() > 0) noise.torque = Eigen::VectorXd::Zero(recording.time.size());
  surefoot::Rng rng(1);
  for (double& reading : noise.angle.reshaped()) reading = rng.normal();
  return smooth_with(noise, half_window, fewest);
}

// [s] by joint, of the filters of torques; 0 where torques are not recorded.
Eigen::VectorXd low_pass_widths(const RobotRecording& recording, const Motion& motion, const Motion& white,
                                const Eigen::VectorXd& noise) {
  Eigen::VectorXd widths = Eigen::VectorXd::Zero(noise.size());
  for (Eigen::Index j = 0; j < recording.torque.cols(); ++j) {
    const double acceleration = low_passed_rms(motion, 0, motion.a.col(j));
    widths[j] = low_pass_width(recording.time, recording.torque.col(j), [&](double width) {
      return noise[j] * low_passed_rms(white, width, white.a.col(0)) / std::max(1e-300, acceleration);
    });
  }
  return widths;
}

// Whether a wider filter changes accelerations, as far as the low-pass filter lets them pass, by no more than the noise
// that the narrower one leaves in them (Lepski's rule), in every joint.
bool differ_by_noise(const Motion& narrow, const Motion& wide, const Motion& white, const Eigen::VectorXd& widths,
                     const Eigen::VectorXd& noise) {
  constexpr double more = 1.1;  // estimates of noise are off by some percent
  for (Eigen::Index j = 0; j < noise.size(); ++j) {
    const double usual = noise[j] * low_passed_rms(white, widths[j], white.a.col(0));
    if (!(low_passed_rms(wide, widths[j], wide.a.col(j) - narrow.a.col(j)) <= more * usual)) return false;
  }
  return true;
}

// Standard deviation of normal numbers whose mean square is this if none counts for more than `limit`: exact for any
// limit, so that numbers of a coarse sensor, few of which differ, do no harm (as a median of them would).
double deviation_of_limited(double limit, double mean_square) {
  constexpr int halvings = 50;
  if (!(mean_square > 0)) return 0;
  const auto expected = [&](double deviation) {
    const double z = limit / deviation, inside = std::erf(z / std::numbers::sqrt2);
    const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
    return deviation * deviation * (inside - 2 * z * density) + limit * limit * (1 - inside);
  };
  double low = std::sqrt(mean_square), high = low;  // limited numbers are smaller
  for (int doubling = 0; doubling < halvings && expected(high) < mean_square; ++doubling) high *= 2;
  for (int halving = 0; halving < halvings; ++halving) {
    const double middle = (low + high) / 2;
    (expected(middle) < mean_square ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

double noise_of(const Eigen::Ref<const Eigen::VectorXd>& readings) {
  constexpr double gain = 70;              // sum of squares of 1, -4, 6, -4, 1
  constexpr std::size_t limited_part = 4;  // of the differences: the largest, which may be jumps of the motion
  std::vector<double> differences;
  for (Eigen::Index k = 4; k < readings.size(); ++k) {
    const double d = readings[k] - 4 * readings[k - 1] + 6 * readings[k - 2] - 4 * readings[k - 3] + readings[k - 4];
    differences.push_back(std::abs(d));
  }
  if (differences.empty()) return 0;
  const auto at = differences.end() - 1 - static_cast<std::ptrdiff_t>(differences.size() / limited_part);
  std::ranges::nth_element(differences, at);
  double limit = *at;
  if (limit == 0) limit = *std::ranges::max_element(differences);  // readings that mostly stay the same
  double square = 0, limited = 0;
  for (const double d : differences) {
    square += d * d / static_cast<double>(differences.size());
    limited += std::pow(std::min(d, limit), 2) / static_cast<double>(differences.size());
  }
  return std::min(std::sqrt(square), deviation_of_limited(limit, limited)) / std::sqrt(gain);
}

Motion smooth(const RobotRecording& recording, const MotionCriteria& criteria) {
  constexpr double narrowest = 0.02;  // [s]: motors and links of robots move at up to some 10 Hz
  constexpr double widest = 0.2;      // [s]
  constexpr double wider = 1.4;       // accelerations have less than half of the noise then
  Eigen::VectorXd noise(recording.angle.cols());
  for (Eigen::Index j = 0; j < noise.size(); ++j) noise[j] = noise_of(recording.angle.col(j));
  const auto at = [&](double half_window) { return smooth_with(recording, half_window, criteria.fewest_rows); };
  const auto with_noise = [&](Motion motion) {
    const Motion white = smooth_noise(recording, motion.half_window, criteria.fewest_rows);
    motion.speed_noise = noise * low_passed_rms(white, 0, white.v.col(0));
    return motion;
  };
  if (criteria.half_window > 0) return with_noise(at(criteria.half_window));
  Motion motion = at(narrowest), accepted = motion;
  Motion white = smooth_noise(recording, narrowest, criteria.fewest_rows);
  const Eigen::VectorXd widths = low_pass_widths(recording, motion, white, noise);
  for (double half_window = narrowest * wider; half_window < widest; half_window *= wider) {
    Motion next = at(half_window);
    if (!differ_by_noise(accepted, next, white, widths, noise)) break;
    motion = std::move(accepted);  // one step less, so that what goes unnoticed is small beside the noise
    accepted = std::move(next);
    white = smooth_noise(recording, half_window, criteria.fewest_rows);
  }
  motion.low_pass = widths;
  return with_noise(std::move(motion));
}

}  // namespace diagnose_robot

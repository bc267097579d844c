// Definitions of surefoot/motion/monitor/change_alarm.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <sstream>
#include <string>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/monitor/change_alarm.hpp"
#include "surefoot/motion/monitor/cholesky.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const AlarmOptions& options) {
  const auto fail = [](const char* what, double value) {
    std::ostringstream text;
    text << "AlarmOptions: " << what << ", got " << value;
    throw MotionError(text.str());
  };
  if (options.window < 2) fail("window must be at least 2", options.window);
  if (!(options.outlier_threshold > 0)) fail("outlier_threshold must be above 0", options.outlier_threshold);
  if (!(options.jump_deviation > 0) || !std::isfinite(options.jump_deviation)) {
    fail("jump_deviation must be a finite number above 0", options.jump_deviation);
  }
}

namespace detail {

/// The score of a jump before some sequences (the gradient of their log likelihood), and its information.
class JumpScore {
 public:
  /// `together` is the sum of the information of the sequences, `about_zero` that of their offsets for parameters 0.
  JumpScore(const MotionTracker& before, const Eigen::MatrixXd& together, const Eigen::VectorXd& about_zero) {
    const Eigen::Index n = about_zero.size();
    const Eigen::VectorXd before_jump = multiply(together, before.model.parameters());
    Eigen::MatrixXd by_information = together, by_offset(n, 1);
    for (Eigen::Index i = 0; i < n; ++i) by_offset(i, 0) = about_zero[i] - before_jump[i];
    const Cholesky all(before.information + together);
    all.solve_in_place(by_information);
    all.solve_in_place(by_offset);
    information_ = multiply(before.information, by_information);
    score_ = multiply(before.information, Eigen::VectorXd(by_offset));
  }

  /// Log likelihood ratio of the likeliest jump of one parameter, or of normally distributed jumps of all with these
  /// standard deviations [nats].
  double ratio(int parameter, const Eigen::VectorXd& deviation) const {
    if (parameter != Change::all) {
      const double known = information_(parameter, parameter);
      return known > 0 ? score_[parameter] * score_[parameter] / (2 * known) : 0;
    }
    const Eigen::Index n = score_.size();
    Eigen::MatrixXd posterior = scaled(deviation, information_);
    Eigen::VectorXd whitened = score_;
    for (Eigen::Index i = 0; i < n; ++i) {
      posterior(i, i) += 1;
      whitened[i] *= deviation[i];
    }
    const Cholesky root(posterior);
    const Eigen::VectorXd half = root.solve_lower(whitened);
    return 0.5 * squared_norm(half) - root.half_log_determinant();
  }

  /// Estimate of the jump and its standard error.
  void describe(Change& change, const Eigen::VectorXd& deviation) const {
    const Eigen::Index n = score_.size();
    change.jump = Eigen::VectorXd::Zero(n);
    change.standard_error = Eigen::VectorXd::Zero(n);
    if (change.parameter != Change::all) {
      const double known = information_(change.parameter, change.parameter);
      change.jump[change.parameter] = score_[change.parameter] / known;
      change.standard_error[change.parameter] = 1 / std::sqrt(known);
      return;
    }
    Eigen::MatrixXd posterior = information_;
    for (Eigen::Index i = 0; i < n; ++i) posterior(i, i) += 1 / (deviation[i] * deviation[i]);
    const Eigen::MatrixXd covariance = Cholesky(posterior).inverse();
    change.jump = multiply(covariance, score_);
    change.standard_error = roots_of_diagonal<Eigen::Dynamic>(covariance);
  }

 private:
  Eigen::VectorXd score_;
  Eigen::MatrixXd information_;
};

SUREFOOT_INLINE Eigen::VectorXd offset_about_zero(const InformationUpdate& update) {
  return update.offset + multiply(update.information, update.at);
}

/// The change with the most evidence; its evidence is 0 if there is none.
SUREFOOT_INLINE Change likeliest_change(const std::deque<RecentSequence>& recent, const Eigen::VectorXd& deviation) {
  const Eigen::Index n = deviation.size();
  Change best;
  Eigen::MatrixXd together = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd about_zero = Eigen::VectorXd::Zero(n);
  for (std::size_t k = recent.size(); k-- > 0;) {
    together += recent[k].update.information;
    about_zero += offset_about_zero(recent[k].update);
    if (k + 1 == recent.size()) continue;
    const JumpScore jump(recent[k].before, together, about_zero);
    std::deque<JumpScore> without;  // one of the sequences, from the first on; filled as needed
    for (int parameter = Change::all; parameter < n; ++parameter) {
      double evidence = jump.ratio(parameter, deviation);
      for (std::size_t left_out = 0; left_out < recent.size() - k && evidence > best.evidence; ++left_out) {
        const InformationUpdate& one = recent[k + left_out].update;
        if (without.size() == left_out) {
          without.emplace_back(recent[k].before, together - one.information, about_zero - offset_about_zero(one));
        }
        evidence = std::min(evidence, 2 * without[left_out].ratio(parameter, deviation));
      }
      if (!(evidence > best.evidence)) continue;
      best = {.parameter = parameter, .since = recent[k].number, .evidence = evidence};
      jump.describe(best, deviation);
    }
  }
  return best;
}

}  // namespace detail

SUREFOOT_INLINE AlarmReport update(ChangeAlarm& alarm, const WalkSequence& sequence) {
  check(alarm.options);
  const InformationUpdate information = linearize(alarm.tracker, sequence);
  forget(alarm.tracker);
  AlarmReport report{.surprise = surprise(alarm.tracker, information)};
  report.outlier = report.surprise.deviations() > alarm.options.outlier_threshold;
  alarm.recent.push_back({.number = ++alarm.count, .before = alarm.tracker, .update = information});
  if (alarm.recent.size() > static_cast<std::size_t>(alarm.options.window)) alarm.recent.pop_front();
  if (!report.outlier) learn(alarm.tracker, information);
  const Eigen::VectorXd deviation =
      detail::times(alarm.options.jump_deviation, alarm.tracker.model.parameter_box().width());
  Change change = detail::likeliest_change(alarm.recent, deviation);
  report.evidence = change.evidence;
  if (change.evidence > alarm.threshold) report.change = std::move(change);
  return report;
}

SUREFOOT_INLINE void adapt(ChangeAlarm& alarm, const Change& change) {
  const auto first = std::find_if(alarm.recent.begin(), alarm.recent.end(),
                                  [&](const detail::RecentSequence& one) { return one.number == change.since; });
  if (first == alarm.recent.end()) {
    throw MotionError("adapt: sequence " + std::to_string(change.since) + " is not among the last ones");
  }
  MotionTracker tracker = first->before;
  Eigen::MatrixXd covariance = tracker.covariance();
  for (int i = 0; i < covariance.rows(); ++i) {
    if (change.parameter == Change::all || change.parameter == i) covariance(i, i) += 1 / tracker.floor(i, i);
  }
  tracker.information = detail::Cholesky(covariance).inverse();
  for (auto one = first; one != alarm.recent.end(); ++one) learn(tracker, one->update);
  alarm.tracker = std::move(tracker);
  alarm.recent.clear();
}

SUREFOOT_INLINE std::string describe(const Change& change, const AnyMotionModel& model) {
  std::ostringstream text;
  text.precision(3);
  if (change.parameter == Change::all) {
    text << "The walk as a whole changed";
  } else {
    const ModelParameter& info = model.parameter_info()[static_cast<std::size_t>(change.parameter)];
    text << info.name << " changed by " << change.jump[change.parameter] << " +- "
         << change.standard_error[change.parameter];
    if (info.unit != "1") text << ' ' << info.unit;
  }
  text << " since sequence " << change.since << '.';
  return text.str();
}

}  // namespace surefoot

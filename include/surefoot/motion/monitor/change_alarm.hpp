// Alarm when a robot no longer walks as calibrated: the generalised likelihood ratio of a jump of one parameter, or of
// all, before any of the last sequences, against none. Willsky and Jones, "A generalized likelihood ratio approach to
// the detection and estimation of jumps in linear systems", IEEE Transactions on Automatic Control 21, 1976; Basseville
// and Nikiforov, "Detection of Abrupt Changes", 1993, chapter 7. What is not known of the parameters before the jump is
// averaged over. Cost of a sequence: window * (parameters + 1)^3 operations, and the update of the tracker.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "surefoot/core/vec.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

struct AlarmOptions {
  int window = 20;      // [sequences] that a change is looked for in; at least 2
  double absurd = 5;    // a sequence this surprising is an outlier [deviations of a normal number]
  double spread = 0.1;  // of a change of all parameters at once [widths of their ranges]
};

/// What changed, since when, and by how much.
template <MotionModel M>
struct Change {
  static constexpr int all = -1;
  using Parameters = Vec<M::parameter_count>;

  int parameter = all;                             // which one; its name is in M::parameter_info()
  Eigen::Index since = 0;                          // number of the first sequence after the change, counted from 1
  Parameters jump = Parameters::Zero();            // in the units of the parameters
  Parameters standard_error = Parameters::Zero();  // of the jump; 0 where nothing changed
  double evidence = 0;                             // log likelihood ratio [nats], see ChangeAlarm
};

namespace detail {

/// A sequence that was heard, with the tracker as it was before.
template <MotionModel M>
struct Heard {
  Eigen::Index number = 0;
  MotionTracker<M> before;
  SequenceSays<M> says;
};

}  // namespace detail

/// An alarm is raised when the evidence of a change is above the threshold. Evidence is the log likelihood ratio of
/// the likeliest change, but no more than twice what is left of it without any one of its sequences: a single wrong
/// reading raises nothing, at least two sequences must agree. The tracker does not learn from an absurd sequence, an
/// outlier; it still counts as evidence, together with others.
template <MotionModel M>
struct ChangeAlarm {
  MotionTracker<M> tracker;  // start it as calibrated
  double threshold = 0;      // [nats], from alarm_threshold
  AlarmOptions options = {};

  std::deque<detail::Heard<M>> recent = {};  // the last sequences, at most `window`
  Eigen::Index count = 0;                    // of sequences heard
};

template <MotionModel M>
struct AlarmReport {
  Surprise surprise = {};                // of this sequence
  bool outlier = false;                  // absurd by itself: probably a wrong reading
  double evidence = 0;                   // [nats]
  std::optional<Change<M>> change = {};  // the alarm
};

namespace detail {

/// The score of a jump before some sequences, and its information.
template <MotionModel M>
struct JumpScore {
  static constexpr int n = M::parameter_count;
  using Square = typename MotionTracker<M>::Square;
  Vec<n> score;
  Square information;

  /// `together` is the sum of the information of the sequences, `about_zero` that of their offsets for parameters 0.
  JumpScore(const MotionTracker<M>& before, const Square& together, const Vec<n>& about_zero) {
    Eigen::Matrix<double, n, n + 1> right;
    right << together, about_zero - together * before.model.parameters();
    const Eigen::LLT<Square> root(before.information + together);
    root.solveInPlace(right);
    information.noalias() = before.information * right.template leftCols<n>();
    score.noalias() = before.information * right.col(n);
  }

  /// Log likelihood ratio of the likeliest jump of one parameter, or of normally distributed jumps of all with the
  /// deviations `spread` [nats].
  double ratio(int parameter, const Vec<n>& spread) const {
    if (parameter != Change<M>::all) {
      const double known = information(parameter, parameter);
      return known > 0 ? score[parameter] * score[parameter] / (2 * known) : 0;
    }
    const Eigen::LLT<Square> root(Square::Identity() + spread.asDiagonal() * information * spread.asDiagonal());
    const Vec<n> half = root.matrixL().solve(spread.cwiseProduct(score));
    return 0.5 * half.squaredNorm() - root.matrixLLT().diagonal().array().log().sum();
  }

  /// Estimate of the jump and its standard error.
  void describe(Change<M>& change, const Vec<n>& spread) const {
    if (change.parameter != Change<M>::all) {
      const double known = information(change.parameter, change.parameter);
      change.jump[change.parameter] = score[change.parameter] / known;
      change.standard_error[change.parameter] = 1 / std::sqrt(known);
      return;
    }
    const Square prior = spread.array().square().inverse().matrix().asDiagonal();
    const Square covariance = (information + prior).llt().solve(Square::Identity());
    change.jump = covariance * score;
    change.standard_error = covariance.diagonal().cwiseSqrt();
  }
};

template <MotionModel M>
Vec<M::parameter_count> offset_about_zero(const SequenceSays<M>& says) {
  return says.offset + says.information * says.at;
}

/// The change with the most evidence; its evidence is 0 if there is none.
template <MotionModel M>
Change<M> likeliest_change(const std::deque<Heard<M>>& recent, const Vec<M::parameter_count>& spread) {
  constexpr int n = M::parameter_count;
  using Square = typename MotionTracker<M>::Square;
  Change<M> best;
  Square together = Square::Zero();
  Vec<n> about_zero = Vec<n>::Zero();
  for (std::size_t k = recent.size(); k-- > 0;) {
    together += recent[k].says.information;
    about_zero += offset_about_zero(recent[k].says);
    if (k + 1 == recent.size()) continue;
    const JumpScore<M> jump(recent[k].before, together, about_zero);
    std::deque<JumpScore<M>> without;  // one of the sequences, in their order; filled as needed
    for (int parameter = Change<M>::all; parameter < n; ++parameter) {
      double evidence = jump.ratio(parameter, spread);
      for (std::size_t left_out = 0; left_out < recent.size() - k && evidence > best.evidence; ++left_out) {
        const SequenceSays<M>& one = recent[k + left_out].says;
        if (without.size() == left_out) {
          without.emplace_back(recent[k].before, together - one.information, about_zero - offset_about_zero(one));
        }
        evidence = std::min(evidence, 2 * without[left_out].ratio(parameter, spread));
      }
      if (!(evidence > best.evidence)) continue;
      best = {.parameter = parameter, .since = recent[k].number, .evidence = evidence};
      jump.describe(best, spread);
    }
  }
  return best;
}

template <MotionModel M>
Vec<M::parameter_count> jump_spread(const AlarmOptions& options) {
  return options.spread * parameter_box<M>().width();
}

}  // namespace detail

/// Throws MotionError, naming the field.
inline void check(const AlarmOptions& options) {
  if (options.window < 2) {
    throw MotionError("AlarmOptions: window must be at least 2, got " + std::to_string(options.window));
  }
  if (!(options.absurd > 0)) {
    throw MotionError("AlarmOptions: absurd must be above 0, got " + std::to_string(options.absurd));
  }
  if (!(options.spread > 0) || !std::isfinite(options.spread)) {
    throw MotionError("AlarmOptions: spread must be a finite number above 0, got " + std::to_string(options.spread));
  }
}

/// Hears one more sequence. A change is reported again after every sequence until `adapt` is called. Throws MotionError
/// if the sequence cannot be used; the alarm is then as it was.
template <MotionModel M>
AlarmReport<M> update(ChangeAlarm<M>& alarm, const WalkSequence& sequence) {
  check(alarm.options);
  const SequenceSays<M> says = listen(alarm.tracker, sequence);
  forget(alarm.tracker);
  AlarmReport<M> report{.surprise = surprise(alarm.tracker, says)};
  report.outlier = report.surprise.deviations() > alarm.options.absurd;
  alarm.recent.push_back({.number = ++alarm.count, .before = alarm.tracker, .says = says});
  if (alarm.recent.size() > static_cast<std::size_t>(alarm.options.window)) alarm.recent.pop_front();
  if (!report.outlier) learn(alarm.tracker, says);
  Change<M> change = detail::likeliest_change(alarm.recent, detail::jump_spread<M>(alarm.options));
  report.evidence = change.evidence;
  if (change.evidence > alarm.threshold) report.change = std::move(change);
  return report;
}

/// Accepts a change that `update` has just reported: what changed is learnt anew from the sequences since, the rest is
/// kept. Throws MotionError if those sequences have left the window.
template <MotionModel M>
void adapt(ChangeAlarm<M>& alarm, const Change<M>& change) {
  const auto first = std::find_if(alarm.recent.begin(), alarm.recent.end(),
                                  [&](const detail::Heard<M>& heard) { return heard.number == change.since; });
  if (first == alarm.recent.end()) {
    throw MotionError("adapt: sequence " + std::to_string(change.since) + " is not among the last ones heard");
  }
  MotionTracker<M> tracker = first->before;
  auto covariance = tracker.covariance();
  for (int i = 0; i < M::parameter_count; ++i) {
    if (change.parameter == Change<M>::all || change.parameter == i) covariance(i, i) += 1 / tracker.floor(i, i);
  }
  tracker.information = covariance.llt().solve(MotionTracker<M>::Square::Identity());
  for (auto heard = first; heard != alarm.recent.end(); ++heard) learn(tracker, heard->says);
  alarm.tracker = std::move(tracker);
  alarm.recent.clear();
}

/// The change as a sentence, e.g. "dx per dx changed by 0.26 +- 0.05 since sequence 31."
template <MotionModel M>
std::string describe(const Change<M>& change) {
  std::ostringstream text;
  text.precision(3);
  if (change.parameter == Change<M>::all) {
    text << "The walk as a whole changed";
  } else {
    const ModelParameter info = M::parameter_info()[static_cast<std::size_t>(change.parameter)];
    text << info.name << " changed by " << change.jump[change.parameter] << " +- "
         << change.standard_error[change.parameter];
    if (info.unit != "1") text << ' ' << info.unit;
  }
  text << " since sequence " << change.since << '.';
  return text.str();
}

}  // namespace surefoot

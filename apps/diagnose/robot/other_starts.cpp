#include "other_starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "limit_along_motion.hpp"
#include "term_priors.hpp"

namespace diagnose_robot {
namespace {

constexpr std::array<double, 3> sizes{1, 3, 9};  // typical ones

bool is_of_joint(const Term& term, int joint) { return term.joints.size() == 1 && term.joints.front() == joint; }

// Without what this joint has for itself.
Point without_joint(const Evidence& evidence, const Point& point, int joint) {
  Point bare{point.theta, point.set, point.starts, {}};
  for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
    if (!is_of_joint(evidence.terms[t], joint)) continue;
    bare.set[t] = 0;
    bare.theta[static_cast<Eigen::Index>(t)] = 0;
  }
  return bare;
}

struct Start {
  Point point;
  std::size_t term = 0;
  bool read = false;  // its size was read off the motion, which says more than the error before anything is fitted
  double misfit = 0;
};

// Sizes at which a term may show that is not there yet: those that were read off the motion, and some others.
std::vector<std::pair<double, bool>> sizes_of(const Evidence& evidence, const RobotPhysics& bare, const Term& term) {
  std::vector<std::pair<double, bool>> result;
  const int joint = term.joints.front();
  const double stated = evidence.robot.joints[static_cast<std::size_t>(joint)].setup.limit;
  if (term.property == Property::torque_limit) {
    for (const double limit : limits_along_motion(evidence, bare, joint)) result.emplace_back(1 - limit / stated, true);
  }
  for (const double size : sizes) {
    for (const double side : {1.0, -1.0}) result.emplace_back(side * size * term.typical, false);
  }
  return result;
}

// A size at its bound explains nothing: errors would fall further beyond what is possible.
bool is_at_bound(const LinearModel& model, const Start& start) {
  const auto t = static_cast<Eigen::Index>(start.term);
  return start.point.theta[t] <= model.low[t] || start.point.theta[t] >= model.high[t];
}

std::vector<Start> starts_at(const Evidence& evidence, const LinearModel& model, const Point& bare, int joint) {
  const RobotPhysics physics = physics_of(evidence.terms, bare.theta, evidence.robot.nominal);
  std::vector<Start> starts;
  for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
    const Term& term = evidence.terms[t];
    if (!is_of_joint(term, joint) || is_of_body(term.property)) continue;
    for (const auto& [value, read] : sizes_of(evidence, physics, term)) {
      const auto at = static_cast<Eigen::Index>(t);
      if (value < model.low[at] || value > model.high[at]) continue;
      Start start{bare, t, read, 0};
      start.point.set[t] = 1;
      start.point.theta[at] = value;
      starts.push_back(std::move(start));
    }
  }
  const auto errors = surefoot::map(
      evidence.threads, starts.size(), [&](std::size_t i) { return errors_at(evidence, starts[i].point.theta, bare.starts); },
      evidence.stop);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    starts[i].point.errors = errors[i];
    starts[i].misfit = errors[i].size() > 0 ? misfit(evidence, model, starts[i].point) : 0;
  }
  std::ranges::stable_sort(starts, {}, &Start::misfit);
  return starts;
}

}  // namespace

// Joints beyond their noise that were not tried yet, of the tree of the worst one, the worst first.
std::vector<int> OtherStarts::worst_joints(const Evidence& evidence, const Point& point) const {
  const Eigen::VectorXd rms = rms_by_joint(evidence, point.errors);
  std::vector<std::pair<double, int>> beyond;
  for (Eigen::Index j = 0; j < rms.size(); ++j) {
    double noise = 0;
    for (const RobotRecording& recording : evidence.recordings)
      noise = std::max(noise, noise_of(recording.angle.col(j)));
    const double numerical = evidence.numerical.size() > 0 ? evidence.numerical[j] : 0;
    const double needed = std::hypot(criteria_.beyond_noise * noise, times_numerical * numerical);
    const double ratio = rms[j] / std::max(1e-12, needed);
    const bool tried = std::ranges::find(tried_, static_cast<int>(j)) != tried_.end();
    if (ratio > 1 && !tried) beyond.emplace_back(ratio, static_cast<int>(j));
  }
  std::ranges::stable_sort(beyond, std::ranges::greater{}, &std::pair<double, int>::first);
  std::vector<int> joints;
  const auto tree = [&](int joint) { return evidence.robot.joints[static_cast<std::size_t>(joint)].tree; };
  for (const auto& [ratio, joint] : beyond) {
    if (static_cast<int>(joints.size()) < criteria_.joints && (joints.empty() || tree(joint) == tree(joints.front())))
      joints.push_back(joint);
  }
  return joints;
}

bool OtherStarts::try_next(const Evidence& evidence, const LinearModel& model, Point& point) {
  if (evidence.robot.setup.drive == DriveKind::torque) return false;
  double least = misfit_and_cost(evidence, model, point) - ChoiceCriteria().needed;
  while (tries_ < criteria_.most_tries) {
    const std::vector<int> joints = worst_joints(evidence, point);
    if (joints.empty()) return false;
    ++tries_;
    bool found = false;
    Point best;
    for (const int joint : joints) {
      tried_.push_back(joint);
      std::vector<std::pair<std::size_t, bool>> seen;  // terms that were fitted
      int others = 0;                                  // of sizes that were not read
      for (Start& start : starts_at(evidence, model, without_joint(evidence, point, joint), joint)) {
        if (evidence.stop.stop_requested()) break;
        const std::pair<std::size_t, bool> one(start.term, start.read);
        if (std::ranges::find(seen, one) != seen.end() || (!start.read && others == criteria_.finalists)) continue;
        seen.push_back(one);
        others += start.read ? 0 : 1;
        settle(evidence, model, criteria_.fits, start.point);
        const double here = misfit_and_cost(evidence, model, start.point);
        if (!(here < least) || is_at_bound(model, start)) continue;
        least = here;
        best = start.point;
        found = true;
      }
    }
    if (found) {
      point = std::move(best);
      return true;
    }
  }
  return false;
}

}  // namespace diagnose_robot

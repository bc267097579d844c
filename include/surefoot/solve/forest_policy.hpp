// A policy that is a regression forest: what RFPI gives, and what runs on the robot.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/box.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/serialize.hpp"
#include "surefoot/solve/agreement.hpp"

namespace surefoot {

/// The features of many states as the forests take them: floats, state after state.
template <Problem P>
std::vector<float> feature_rows(const P& problem, std::span<const typename P::State> states) {
  constexpr int width = feature_dim<P>();
  std::vector<float> rows(states.size() * width);
  for (std::size_t i = 0; i < states.size(); ++i) {
    Eigen::Map<Eigen::Matrix<float, width, 1>>(rows.data() + i * width) =
        features(problem, states[i]).template cast<float>();
  }
  return rows;
}

/// Maps a state's features through a forest with linear leaves to an action inside the action box. No memory, no
/// allocation up to 256 numbers from all trees together: well under a microsecond on a desktop core. Holds a copy of
/// the problem, for its features and its box.
template <Problem P>
class ForestPolicy {
 public:
  using State = typename P::State;
  using Action = typename P::Action;
  using ActionForest = Forest<feature_dim<P>(), P::action_dim, LinearLeaf>;

  /// `agreement`: how far actions of trees may be apart to count as one opinion [half widths of the action box]; see
  /// agreed_action(). Infinite: the mean of all trees.
  ForestPolicy(P problem, ActionForest forest, double agreement = std::numeric_limits<double>::infinity())
      : problem_(std::move(problem)),
        box_(problem_.action_box()),
        forest_(std::move(forest)),
        agreement_(agreement),
        reach_(0.5 * agreement * box_.width()) {}

  Action operator()(const State& state) const {
    if (!looks_for_agreement()) return box_.clamp(forest_.predict(features(problem_, state)));
    const Eigen::Matrix<float, feature_dim<P>(), 1> row = features(problem_, state).template cast<float>();
    const std::size_t count = forest_.trees() * P::action_dim;
    std::array<double, 256> room;
    if (count > room.size()) {
      std::vector<double> more(count);
      return agreed(row.data(), more);
    }
    return agreed(row.data(), std::span(room).first(count));
  }

  /// The actions of many states: faster than one after the other, same bits.
  std::vector<Action> act(std::span<const State> states) const {
    const std::vector<float> rows = feature_rows(problem_, states);
    std::vector<Action> actions(states.size());
    static_assert(sizeof(Action) == P::action_dim * sizeof(double));
    if (states.empty()) return actions;
    if (!looks_for_agreement()) {
      forest_.predict(rows.data(), states.size(), actions[0].data());
      for (Action& action : actions) action = box_.clamp(action);
      return actions;
    }
    const std::size_t each = forest_.trees() * P::action_dim;
    std::vector<double> proposals(states.size() * each);
    forest_.predict_trees(rows.data(), states.size(), proposals.data());
    for (std::size_t i = 0; i < states.size(); ++i) {
      actions[i] =
          box_.clamp(agreed_action<P::action_dim>(std::span<const double>(proposals).subspan(i * each, each), reach_));
    }
    return actions;
  }

  const ActionForest& forest() const { return forest_; }
  const P& problem() const { return problem_; }
  double agreement() const { return agreement_; }

 private:
  bool looks_for_agreement() const { return agreement_ < std::numeric_limits<double>::infinity(); }

  Action agreed(const float* row, std::span<double> proposals) const {
    forest_.predict_trees(row, 1, proposals.data());
    return box_.clamp(agreed_action<P::action_dim>(proposals, reach_));
  }

  P problem_;
  Box<P::action_dim> box_;
  ActionForest forest_;
  double agreement_;
  Vec<P::action_dim> reach_;  // agreement in the units of the actions
};

namespace detail {

constexpr FileFormat policy_format{"SUREPLCY", 1, "a policy file"};
constexpr FileFormat agreeing_policy_format{"SUREPLCY", 2, "a policy file"};  // the forest is followed by the agreement

/// Features at a few fixed states: tells whether a file and a problem speak of the same features.
template <Problem P>
std::vector<double> feature_probe(const P& problem) {
  std::vector<double> probe;
  const auto box = problem.state_box();
  for (const double unit : {0.31, 0.5, 0.83}) {
    const auto values = features(problem, box.from_unit(Vec<P::state_dim>::Constant(unit)));
    probe.insert(probe.end(), values.begin(), values.end());
  }
  return probe;
}

}  // namespace detail

/// Writes a policy file: magic, version, dimensions, action box, probe of the features, forest, checksum.
template <Problem P>
void save_policy(const std::string& path, const ForestPolicy<P>& policy) {
  const Box<P::action_dim> box = policy.problem().action_box();
  const bool agreeing = std::isfinite(policy.agreement());
  ByteWriter out;
  write_format(out, agreeing ? detail::agreeing_policy_format : detail::policy_format);
  out.u32(P::state_dim);
  out.u32(P::action_dim);
  out.u32(feature_dim<P>());
  for (const double bound : box.low()) out.f64(bound);
  for (const double bound : box.high()) out.f64(bound);
  out.list(detail::feature_probe(policy.problem()));
  write(out, policy.forest());
  if (agreeing) out.f64(policy.agreement());
  out.add_checksum();
  write_file_atomically(path, out.bytes());
}

/// Reads a policy file. Throws SolveError, CoreError or ForestError if it is damaged or was made for another problem.
template <Problem P>
ForestPolicy<P> load_policy(const P& problem, const std::string& path) {
  const Bytes bytes = read_file(path);
  ByteReader in(bytes, "policy file " + path);
  const bool agreeing = has_format(in, detail::agreeing_policy_format);
  expect_format(in, agreeing ? detail::agreeing_policy_format : detail::policy_format);
  auto expect = [&](int wanted, const char* what) {
    if (const auto found = in.u32(); found != static_cast<std::uint32_t>(wanted)) {
      throw SolveError(in.source() + " has " + std::to_string(found) + " " + what + ", this problem has " +
                       std::to_string(wanted));
    }
  };
  expect(P::state_dim, "state dimensions");
  expect(P::action_dim, "action dimensions");
  expect(feature_dim<P>(), "features");
  const Box<P::action_dim> box = problem.action_box();
  for (const auto& bounds : {box.low(), box.high()}) {
    for (const double bound : bounds) {
      if (in.f64() != bound)
        throw SolveError(in.source() + " was made for another action box: name the problem it was trained on");
    }
  }
  const std::vector<double> probe = in.list<double>();
  const std::vector<double> expected = detail::feature_probe(problem);
  const bool same = std::ranges::equal(probe, expected,
                                       [](double a, double b) { return std::abs(a - b) <= 1e-9 * (1 + std::abs(b)); });
  if (!same) throw SolveError(in.source() + " was trained on other features than this problem's: train it anew");
  auto forest = read<typename ForestPolicy<P>::ActionForest>(in);
  const double agreement = agreeing ? in.f64() : std::numeric_limits<double>::infinity();
  in.expect_checksum();
  in.expect_end();
  if (!(agreement > 0)) in.fail("is damaged: its agreement must be positive");
  return ForestPolicy<P>(problem, std::move(forest), agreement);
}

}  // namespace surefoot

// A check of a user's problem by running it, with complaints in plain English, before hours of training.
// Cost: about 8 * runs * horizon steps of the problem, one thread besides the caller's.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"

namespace surefoot {

struct ValidateOptions {
  int runs = 100;    // with random actions, from the problem's initial states
  int horizon = 30;  // [transitions]
};

/// Throws a CoreError that names the field and its range.
void check(const ValidateOptions& options);

namespace detail {

/// A piece of a complaint; numbers with six digits.
std::string text_of(double number);
std::string text_of(std::integral auto number) { return std::to_string(number); }
inline std::string_view text_of(std::string_view text) { return text; }

/// "[1, 2.5]", numbers with four digits.
std::string list_of(const double* numbers, std::size_t count);

/// check() as another thread sees it; its exceptions come here.
bool ask_another_thread(bool (*check)(const void*), const void* argument);

/// What is behind one call of validate(); see there.
template <Problem P>
class Validation {
 public:
  Validation(const P& problem, const ValidateOptions& options, std::uint64_t seed)
      : problem_(problem), states_(problem.state_box()), actions_(problem.action_box()), seed_(seed) {
    surefoot::check(options);
    check_boxes_and_names();
    const bool repeats = unless_it_throws("in a run with actions of action_box(): accept them",
                                          [&] { return make_runs(options) && check_repeats(); });
    if (!repeats) return;  // the other checks would only say it again
    check_leaving();
    check_learnable();
    unless_it_throws("in features(): let it accept all states of runs", [&] { return check_features(); });
    unless_it_throws("for an action in a corner of action_box(): accept it", [&] { return check_action_effects(); });
    unless_it_throws("in a corner of state_box(): shrink the box to states that can be",
                     [&] { return check_corners(); });
    unless_it_throws("for an action outside action_box(): clamp it in step()", [&] { return check_outside_actions(); });
  }

  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  using State = typename P::State;
  using Action = typename P::Action;
  using Transition = Step<State>;
  static constexpr double infinite = std::numeric_limits<double>::infinity();
  static constexpr double rounding = 1e-9;  // [widths of the box]: some thousand roundings in a step, and no program's
                                            // own memory or randomness is so small

  struct Probe {
    State state;
    Action action;
    Rng noise;
    Transition result;
    bool first;  // of its run
  };

  // Adds a complaint; false, so that a check can end with it.
  template <class... Parts>
  bool complain(const Parts&... parts) {
    std::string text;
    ((text += detail::text_of(parts)), ...);
    complaints_.push_back(std::move(text));
    return false;
  }

  template <std::predicate Check>
  bool unless_it_throws(const char* where_and_cure, Check&& check) {
    try {
      return check();
    } catch (const std::exception& error) {
      return complain("the problem threw \"", error.what(), "\" ", where_and_cure);
    }
  }

  std::string state_dimension(int i) const {
    const std::vector<std::string> names = state_names(problem_);
    const auto index = static_cast<std::size_t>(i);
    return index < names.size() ? names[index] : "dimension " + std::to_string(i);
  }

  Transition step(const State& state, const Action& action, Rng noise) const {
    return problem_.step(state, action, noise);
  }
  static bool same(const State& a, const State& b) { return (a.array() == b.array()).all(); }
  static bool same(const Transition& a, const Transition& b) {
    return same(a.next, b.next) && a.reward == b.reward && a.terminal == b.terminal;
  }
  static bool finite(const Transition& t) { return t.next.allFinite() && std::isfinite(t.reward); }

  template <int N>
  static Vec<N> random_corner(const Box<N>& box, Rng& rng) {
    Vec<N> corner = box.low();
    for (int i = 0; i < N; ++i) {
      if (rng.below(2) == 1) corner[i] = box.high()[i];
    }
    return corner;
  }

  void check_boxes_and_names() {
    for (int i = 0; i < P::state_dim; ++i) {
      if (states_.width()[i] == 0) complain("state_box() has no width in ", state_dimension(i), ": widen or drop it");
    }
    for (int i = 0; i < P::action_dim; ++i) {
      if (actions_.width()[i] == 0) complain("action_box() has no width in dimension ", i, ": widen or drop it");
    }
    if (const std::size_t names = state_names(problem_).size(); names != P::state_dim) {
      complain("state_names() gives ", names, " names for ", P::state_dim, " dimensions: give one for each");
    }
    if constexpr (requires { problem_.action_names(); }) {
      if (const std::size_t names = problem_.action_names().size(); names != P::action_dim) {
        complain("action_names() gives ", names, " names for ", P::action_dim, " dimensions: give one for each");
      }
    }
  }

  // Runs with random actions, every other one a corner of the box. Stops at the first non-finite number.
  bool make_runs(const ValidateOptions& options) {
    std::vector<State> outside;
    for (int run = 0; run < options.runs; ++run) {
      const Rng rng(seed_, run);
      Rng start = rng.stream(0);
      Rng again = start;
      State state = problem_.initial_state(start);
      if (!state.allFinite()) return complain("initial_state() gave a number that is not finite: check its arithmetic");
      if (!same(state, problem_.initial_state(again))) {
        return complain(
            "initial_state() gave two states for equal Rng: draw all its randomness from the Rng it is given");
      }
      if (!states_.contains(state)) outside.push_back(state);
      for (int t = 0; t < options.horizon; ++t) {
        Rng choice = rng.stream(1, t);
        const Action action = t % 2 == 0 ? actions_.sample(choice) : random_corner(actions_, choice);
        const Rng noise = rng.stream(2, t);
        const Transition result = step(state, action, noise);
        if (!result.next.allFinite()) return complain_non_finite("next state", state, action);
        if (!std::isfinite(result.reward)) return complain_non_finite("reward", state, action);
        probes_.push_back({state, action, noise, result, t == 0});
        if (result.terminal) break;
        state = result.next;
      }
    }
    if (!outside.empty()) {
      complain("initial_state() was outside state_box() in ", outside.size(), " of ", options.runs, " runs, as in ",
               list(outside.front()), ": widen the box or correct the start");
    }
    return true;
  }

  bool complain_non_finite(const char* what, const State& state, const Action& action) {
    return complain("step() gave a ", what, " that is not finite, from state ", list(state), " and action ",
                    list(action), ": check its arithmetic");
  }

  template <class Vector>
  static std::string list(const Vector& numbers) {
    return list_of(numbers.data(), static_cast<std::size_t>(numbers.size()));
  }

  // Every step once more: backwards, which shows hidden memory, and on another thread.
  bool check_repeats() {
    const double here = largest_difference();
    double there = 0;
    const auto ask = [&] {
      there = largest_difference();
      return true;
    };
    ask_another_thread([](const void* any) { return (*static_cast<decltype(&ask)>(any))(); }, &ask);
    const double larger = std::max(here, there);
    if (larger == 0) return true;
    if (larger <= rounding) {
      return complain("step() gave two results for the same state, action and Rng", here == 0 ? " on two threads" : "",
                      ", but only in the last digits (", larger,
                      " of the range): most likely the compiler fuses multiplications and additions in one copy of the "
                      "code and not in another; compile with -ffp-contract=off");
    }
    return here > rounding
               ? complain(
                     "step() gave another result for the same state, action and Rng: let it change nothing "
                     "(no static or mutable variables) and draw all its randomness from the Rng it is given")
               : complain(
                     "step() gave another result on another thread: use no thread_local or otherwise "
                     "thread-bound variables in it");
  }

  // Largest difference of a step made now from what it was [widths of the state box, largest reward]; infinite if one
  // of the two is terminal.
  double largest_difference() const {
    double largest = 0, scale = 0;
    for (const Probe& p : probes_) scale = std::max(scale, std::abs(p.result.reward));
    const auto add = [&largest](double difference, double range) {
      if (difference != 0) largest = std::max(largest, range > 0 ? difference / range : infinite);
    };
    for (auto p = probes_.rbegin(); p != probes_.rend(); ++p) {
      const Transition now = step(p->state, p->action, p->noise);
      if (!finite(now) || now.terminal != p->result.terminal) return infinite;
      for (int i = 0; i < P::state_dim; ++i) add(std::abs(now.next[i] - p->result.next[i]), states_.width()[i]);
      add(std::abs(now.reward - p->result.reward), scale);
    }
    return largest;
  }

  bool check_features() {
    if constexpr (HasFeatures<P>) {
      for (const Probe& p : probes_) {
        const auto once = problem_.features(p.state);
        if (!once.allFinite()) {
          return complain("features() gave a number that is not finite, for state ", list(p.state),
                          ": check its arithmetic");
        }
        if (once != problem_.features(p.state)) {
          return complain("features() gave two values for one state: let it depend on the state alone");
        }
      }
    } else if constexpr (requires(const State& s) { problem_.features(s); } || requires { P::feature_dim; }) {
      return complain(
          "features() is ignored: it needs `int feature_dim` and `Vec<feature_dim> features(const State&) const`");
    }
    return true;
  }

  void check_leaving() {
    const auto count = static_cast<double>(probes_.size());
    for (int i = 0; i < P::state_dim; ++i) {
      double farthest = 0;
      int times = 0;
      bool changes = false;
      for (const Probe& p : probes_) {
        const double next = p.result.next[i];
        changes = changes || next != p.state[i];
        const double beyond = std::max(next - states_.high()[i], states_.low()[i] - next);
        if (beyond > 0 && !p.result.terminal) {
          ++times;
          farthest = std::max(farthest, beyond);
        }
      }
      if (times > 0) {
        complain("remark: step() left state_box() in ", state_dimension(i), " after ", 100 * times / count,
                 " % of transitions, by up to ", farthest,
                 ": clamp there, widen the box, or ignore this if it is meant");
      }
      if (!changes) {
        complain("remark: step() never changed ", state_dimension(i),
                 ": update it, drop it, or ignore this if it is a constant of each run");
      }
    }
  }

  void check_learnable() {
    const auto runs = std::count_if(probes_.begin(), probes_.end(), [](const Probe& p) { return p.first; });
    const auto at_once =
        std::count_if(probes_.begin(), probes_.end(), [](const Probe& p) { return p.first && p.result.terminal; });
    if (2 * at_once > runs) {
      complain("step() was terminal at once in ", at_once, " of ", runs,
               " runs: start further from the end, or check the condition");
    }
    const Transition& one = probes_.front().result;
    if (std::all_of(probes_.begin(), probes_.end(), [&](const Probe& p) {
          return p.result.reward == one.reward && p.result.terminal == one.terminal;
        })) {
      complain("step() gave the reward ", one.reward, " in all ", probes_.size(),
               " transitions: reward what is wanted, or let initial_state() start nearer to it");
    }
  }

  bool check_action_effects() {
    for (int i = 0; i < P::action_dim; ++i) {
      const auto without_effect = [&](const Probe& p) {
        Action low = p.action;
        Action high = p.action;
        low[i] = actions_.low()[i];
        high[i] = actions_.high()[i];
        return same(step(p.state, low, p.noise), p.result) && same(step(p.state, high, p.noise), p.result);
      };
      if (actions_.width()[i] > 0 && std::all_of(probes_.begin(), probes_.end(), without_effect)) {
        complain("step() never heeded dimension ", i, " of the action: use it or drop it");
      }
    }
    return true;
  }

  // States in the corners of the box, where the runs may never have been.
  bool check_corners() {
    Rng rng(seed_, ~std::uint64_t{0});
    for (int i = 0; i < 256; ++i) {
      const State state = random_corner(states_, rng);
      const Action action = random_corner(actions_, rng);
      if (!finite(step(state, action, rng.stream(i)))) return complain_non_finite("result", state, action);
    }
    return true;
  }

  bool check_outside_actions() {
    bool clamped = true;
    for (const Probe& p : probes_) {
      const Action outside = actions_.center() + 3 * (p.action - actions_.center());
      const Transition result = step(p.state, outside, p.noise);
      if (!finite(result)) return complain_non_finite("result", p.state, outside);
      clamped = clamped && same(result, step(p.state, actions_.clamp(outside), p.noise));
    }
    return clamped || complain("remark: step() obeys actions outside action_box(): clamp them if the machine would");
  }

  const P& problem_;
  Box<P::state_dim> states_;
  Box<P::action_dim> actions_;
  std::uint64_t seed_;
  std::vector<Probe> probes_;
  std::vector<std::string> complaints_;
};

}  // namespace detail

/// Complaints about a problem, each one sentence that names the member and the cure; empty if there are none. What may
/// well be meant starts with "remark: ". Checks: finite numbers, equal results for equal random numbers (again, and on
/// another thread; differences of rounding alone, as fused multiplications and additions make, are told apart), states
/// inside their box, boxes with width, actions that have an effect and may leave their box, rewards that differ, states
/// that change, runs that last, features, names, exceptions.
template <Problem P>
std::vector<std::string> validate(const P& problem, const ValidateOptions& options = {}, std::uint64_t seed = 0) {
  return detail::Validation<P>(problem, options, seed).complaints();
}

/// What a type that is no Problem gets.
template <class P>
  requires(!Problem<P>)
auto validate(const P&, const ValidateOptions& = {}, std::uint64_t = 0) {
  return explain_problem<P>();
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/core/validate.ipp"
#endif

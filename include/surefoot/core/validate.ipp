// Definitions of surefoot/core/validate.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <limits>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/validate.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const ValidateOptions& options) {
  if (std::min(options.runs, options.horizon) < 1) {
    throw CoreError("ValidateOptions: runs and horizon must be at least 1");
  }
}

namespace detail {

/// A piece of a complaint; numbers with six digits.
SUREFOOT_ONCE std::string text_of(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}

inline std::string text_of(std::integral auto number) { return std::to_string(number); }
inline std::string_view text_of(std::string_view text) { return text; }

/// "[1, 2.5]", numbers with four digits.
SUREFOOT_ONCE std::string list_of(const double* numbers, std::size_t count) {
  std::string list = "[";
  for (std::size_t i = 0; i < count; ++i) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", numbers[i]);
    list += (i == 0 ? "" : ", ") + std::string(text);
  }
  return list + "]";
}

/// check() as another thread sees it; its exceptions come here.
SUREFOOT_ONCE bool ask_another_thread(bool (*check)(const void*), const void* argument) {
  bool answer = false;
  std::exception_ptr error;
  std::jthread([&] {
    try {
      answer = check(argument);
    } catch (...) {
      error = std::current_exception();
    }
  }).join();
  if (error) std::rethrow_exception(error);
  return answer;
}

/// What is behind one call of validate(); see there.
class Validation {
 public:
  Validation(const ErasedProblem& problem, const ValidateOptions& options, std::uint64_t seed)
      : problem_(problem), states_(problem.states), actions_(problem.actions), seed_(seed) {
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
  using State = Eigen::VectorXd;
  using Action = Eigen::VectorXd;
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

  std::string state_dimension(Eigen::Index i) const {
    const auto index = static_cast<std::size_t>(i);
    return index < problem_.state_names.size() ? problem_.state_names[index] : "dimension " + std::to_string(i);
  }

  Transition step(const State& state, const Action& action, Rng noise) const {
    return problem_.step(state, action, noise);
  }
  static bool same(const State& a, const State& b) { return (a.array() == b.array()).all(); }
  static bool same(const Transition& a, const Transition& b) {
    return same(a.next, b.next) && a.reward == b.reward && a.terminal == b.terminal;
  }
  static bool finite(const Transition& t) { return t.next.allFinite() && std::isfinite(t.reward); }

  static Eigen::VectorXd random_corner(const Box<Eigen::Dynamic>& box, Rng& rng) {
    Eigen::VectorXd corner = box.low();
    for (Eigen::Index i = 0; i < corner.size(); ++i) {
      if (rng.below(2) == 1) corner[i] = box.high()[i];
    }
    return corner;
  }

  void check_boxes_and_names() {
    for (Eigen::Index i = 0; i < states_.size(); ++i) {
      if (states_.width()[i] == 0) complain("state_box() has no width in ", state_dimension(i), ": widen or drop it");
    }
    for (Eigen::Index i = 0; i < actions_.size(); ++i) {
      if (actions_.width()[i] == 0) complain("action_box() has no width in dimension ", i, ": widen or drop it");
    }
    check_names("state_names() gives ", problem_.state_names.size(), states_.size());
    if (problem_.action_names) check_names("action_names() gives ", *problem_.action_names, actions_.size());
  }

  void check_names(const char* who_gives, std::size_t names, Eigen::Index dimensions) {
    if (names == static_cast<std::size_t>(dimensions)) return;
    complain(who_gives, names, " names for ", dimensions, " dimensions: give one for each");
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

  static std::string list(const Eigen::VectorXd& numbers) {
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
      for (Eigen::Index i = 0; i < states_.size(); ++i)
        add(std::abs(now.next[i] - p->result.next[i]), states_.width()[i]);
      add(std::abs(now.reward - p->result.reward), scale);
    }
    return largest;
  }

  bool check_features() {
    if (problem_.features) {
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
    } else if (problem_.features_ignored) {
      return complain(
          "features() is ignored: it needs `int feature_dim` and `Vec<feature_dim> features(const State&) const`");
    }
    return true;
  }

  void check_leaving() {
    const auto count = static_cast<double>(probes_.size());
    for (Eigen::Index i = 0; i < states_.size(); ++i) {
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
    for (Eigen::Index i = 0; i < actions_.size(); ++i) {
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

  const ErasedProblem& problem_;
  const Box<Eigen::Dynamic>&states_, &actions_;
  std::uint64_t seed_;
  std::vector<Probe> probes_;
  std::vector<std::string> complaints_;
};

SUREFOOT_ONCE std::vector<std::string> complaints_about(const ErasedProblem& problem, const ValidateOptions& options,
                                                        std::uint64_t seed) {
  check(options);
  return Validation(problem, options, seed).complaints();
}

}  // namespace detail
}  // namespace surefoot

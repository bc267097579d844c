#include "surefoot/core/validate.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace surefoot {
namespace {

// Nothing to complain about. Each broken problem below hides one of its members by a bad one.
struct Good {
  static constexpr int state_dim = 2, action_dim = 2;
  using State = Vec<2>;
  using Action = Vec<2>;
  Box<2> state_box() const { return Box<2>::symmetric(State(1, 1)); }
  Box<2> action_box() const { return Box<2>::symmetric(Action(0.1, 0.1)); }
  State initial_state(Rng& rng) const { return state_box().sample(rng); }
  Step<State> step(const State& state, const Action& action, Rng& rng) const {
    const State next = state_box().clamp(state + action_box().clamp(action) + 0.01 * State(rng.normal(), rng.normal()));
    return {next, -next.squaredNorm(), false};
  }
};

template <class P>
void complains_only(const P& problem, const std::string& about) {
  const std::vector<std::string> complaints = validate(problem);
  std::string all;
  for (const std::string& complaint : complaints) all += complaint + "\n";
  CAPTURE(all);
  CHECK(complaints.size() == 1);
  CHECK(all.find(about) != std::string::npos);
}

TEST_CASE("a good problem gives no complaint, whatever the seed") {
  for (const std::uint64_t seed : {0U, 1U, 2U}) CHECK(validate(Good{}, {}, seed).empty());
}

TEST_CASE("a box without width is named") {
  struct FlatState : Good {
    Box<2> state_box() const { return Box<2>(State(-1, 0), State(1, 0)); }
    std::vector<std::string> state_names() const { return {"x", "y"}; }
    State initial_state(Rng& rng) const { return state_box().sample(rng); }
    Step<State> step(const State& state, const Action& action, Rng&) const {
      const State next(std::clamp(state[0] + std::clamp(action[0] + action[1], -0.1, 0.1), -1.0, 1.0), 0);
      return {next, -next.squaredNorm(), false};
    }
  };
  const auto complaints = validate(FlatState{});
  CHECK(std::ranges::count(complaints, "state_box() has no width in y: widen or drop it") == 1);

  struct FlatAction : Good {
    Box<2> action_box() const { return Box<2>(Action(0, -0.1), Action(0, 0.1)); }
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      return Good::step(state, action_box().clamp(action), rng);
    }
  };
  complains_only(FlatAction{}, "action_box() has no width in dimension 0");
}

TEST_CASE("names that do not match the dimensions are named") {
  struct Nameless : Good {
    std::vector<std::string> state_names() const { return {"x"}; }
  };
  complains_only(Nameless{}, "state_names() gives 1 names for 2 dimensions");
  struct TooMany : Good {
    std::vector<std::string> action_names() const { return {"a", "b", "c"}; }
  };
  complains_only(TooMany{}, "action_names() gives 3 names for 2 dimensions");
}

TEST_CASE("initial states outside their box are counted") {
  struct Outside : Good {
    State initial_state(Rng& rng) const { return State(rng.uniform(-1, 1), rng.uniform(1.5, 1.6)); }
  };
  complains_only(Outside{}, "initial_state() was outside state_box() in 100 of 100 runs, as in [");
}

TEST_CASE("an initial state that is not finite or does not repeat is named") {
  struct NotFinite : Good {
    State initial_state(Rng&) const { return State(0, std::log(-1.0)); }
  };
  complains_only(NotFinite{}, "initial_state() gave a number that is not finite");
  struct OwnRandomness : Good {
    mutable double drift = 0;
    State initial_state(Rng&) const { return State(0, drift += 1e-6); }
  };
  complains_only(OwnRandomness{}, "initial_state() gave two states for equal Rng");
}

TEST_CASE("a step that changes something is found") {
  struct Counting : Good {
    mutable std::atomic<int> calls = 0;
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      result.reward += 1e-9 * ++calls;
      return result;
    }
  };
  complains_only(Counting{}, "step() gave another result for the same state, action and Rng");
}

TEST_CASE("a step that draws from a generator of its own is found") {
  struct OwnRandomness : Good {
    Step<State> step(const State& state, const Action& action, Rng&) const {
      static Rng own(1);
      return Good::step(state, action, own);
    }
  };
  complains_only(OwnRandomness{}, "step() gave another result for the same state, action and Rng");
}

TEST_CASE("a step that depends on its thread is found") {
  struct ThreadBound : Good {
    std::thread::id home = std::this_thread::get_id();
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      if (std::this_thread::get_id() != home) result.reward -= 1;
      return result;
    }
  };
  complains_only(ThreadBound{}, "on another thread");
}

TEST_CASE("a difference in the last digits is put down to fused multiplications and additions") {
  struct FusedElsewhere : Good {  // as if the compiler had fused one of two copies of the code
    std::thread::id home = std::this_thread::get_id();
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      volatile const double square = state[0] * state[0];
      const bool fused = std::this_thread::get_id() != home;
      result.reward = fused ? std::fma(state[0], state[0], -state[1]) : square - state[1];
      return result;
    }
  };
  complains_only(FusedElsewhere{}, "on two threads, but only in the last digits");
  struct FusedNowAndThen : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      static int calls = 0;
      auto result = Good::step(state, action, rng);
      if (++calls % 2 == 0) result.next[1] = std::nextafter(result.next[1], 0.0);
      return result;
    }
  };
  complains_only(FusedNowAndThen{}, "compile with -ffp-contract=off");
}

TEST_CASE("a next state or reward that is not finite is named with where it happened") {
  struct RootOfState : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      result.next[1] = std::sqrt(result.next[1]);
      return result;
    }
  };
  complains_only(RootOfState{}, "step() gave a next state that is not finite, from state [");
  struct InfiniteReward : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      if (state[0] > 0.5) result.reward = -std::numeric_limits<double>::infinity();
      return result;
    }
  };
  complains_only(InfiniteReward{}, "step() gave a reward that is not finite");
}

TEST_CASE("a corner of the state box where the step breaks down is found") {
  struct AcosInCorner : Good {  // starts and stays near the middle
    State initial_state(Rng& rng) const { return 0.1 * state_box().sample(rng); }
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      result.next *= 0.5;
      if (state.minCoeff() > 0.99) result.reward = std::acos(1.0 + state[0]);
      return result;
    }
  };
  complains_only(AcosInCorner{}, "step() gave a result that is not finite, from state [1, 1]");
  struct ThrowsInCorner : AcosInCorner {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      if (state.maxCoeff() > 0.99) throw std::runtime_error("too far");
      return AcosInCorner::step(state, action, rng);
    }
  };
  complains_only(ThrowsInCorner{}, "the problem threw \"too far\" in a corner of state_box()");
}

TEST_CASE("states that leave their box are remarked with dimension, share and distance") {
  struct Leaves : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      result.next[1] += state[1] > 0.9 ? 2 : 0;
      result.next[1] -= state[1] > 2 ? 2 : 0;
      return result;
    }
  };
  complains_only(Leaves{}, "remark: step() left state_box() in state 1 after ");
  struct LeavesAtEnd : Good {  // which is what ends are for
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      if (state[1] > 0.9) result = {State(state[0], 1.5), -100, true};
      return result;
    }
  };
  CHECK(validate(LeavesAtEnd{}).empty());
}

TEST_CASE("a state dimension that never changes is remarked") {
  struct Frozen : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, Action(action[0], 0), rng);
      result.next[1] = state[1];
      result.reward -= std::abs(action_box().clamp(action)[1]);
      return result;
    }
  };
  complains_only(Frozen{}, "remark: step() never changed state 1");
}

TEST_CASE("an action without effect is found") {
  struct Deaf : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      return Good::step(state, Action(action[0], 0), rng);
    }
  };
  complains_only(Deaf{}, "step() never heeded dimension 1 of the action");
}

TEST_CASE("actions outside their box are remarked if obeyed, and must not break the step") {
  struct Obeys : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      result.reward -= action.squaredNorm();
      return result;
    }
  };
  complains_only(Obeys{}, "remark: step() obeys actions outside action_box()");
  struct Breaks : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      if (!action_box().contains(action)) result.reward = std::nan("");
      return result;
    }
  };
  complains_only(Breaks{}, "step() gave a result that is not finite");
  struct Throws : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      if (!action_box().contains(action)) throw std::runtime_error("bad action");
      return Good::step(state, action, rng);
    }
  };
  complains_only(Throws{}, "the problem threw \"bad action\" for an action outside action_box()");
}

TEST_CASE("a step that throws in an ordinary run is named") {
  struct Throws : Good {
    Step<State> step(const State&, const Action&, Rng&) const { throw std::runtime_error("no"); }
  };
  complains_only(Throws{}, "the problem threw \"no\" in a run with actions of action_box()");
}

TEST_CASE("runs that end at once are counted") {
  struct Short : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      auto result = Good::step(state, action, rng);
      result.terminal = true;
      return result;
    }
  };
  complains_only(Short{}, "step() was terminal at once in 100 of 100 runs");
}

TEST_CASE("a reward that never differs is found, unless the length of the run makes the difference") {
  struct Indifferent : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      return {Good::step(state, action, rng).next, -1, false};
    }
  };
  complains_only(Indifferent{}, "step() gave the reward -1 in all 3000 transitions");
  struct Hurries : Good {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      return {Good::step(state, action, rng).next, -1, state.norm() < 0.2};
    }
  };
  CHECK(validate(Hurries{}).empty());
}

struct FeaturesNotFinite : Good {
  static constexpr int feature_dim = 1;
  Vec<1> features(const State& state) const { return Vec<1>(std::log(state[0])); }
};
struct FeaturesChanging : Good {
  static constexpr int feature_dim = 1;
  mutable std::atomic<int> calls = 0;
  Vec<1> features(const State&) const { return Vec<1>(static_cast<double>(++calls)); }
};
struct FeaturesWithoutSize : Good {
  template <class S>
  Vec<3> features(const S&) const {
    return Vec<3>::Zero();
  }
};

TEST_CASE("features that are not finite, not repeatable or ignored are found") {
  complains_only(FeaturesNotFinite{}, "features() gave a number that is not finite");
  complains_only(FeaturesChanging{}, "features() gave two values for one state");
  complains_only(FeaturesWithoutSize{}, "features() is ignored");
}

TEST_CASE("impossible options are refused") {
  CHECK_THROWS_AS(validate(Good{}, {.runs = 0}), CoreError);
  CHECK_THROWS_AS(validate(Good{}, {.horizon = 0}), CoreError);
}

}  // namespace
}  // namespace surefoot

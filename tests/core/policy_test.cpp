#include "surefoot/core/policy.hpp"

#include <doctest/doctest.h>

#include "tests/support/double_integrator.hpp"

namespace surefoot {
namespace {

using toy::DoubleIntegrator;
using State = DoubleIntegrator::State;
using Action = DoubleIntegrator::Action;

struct Counter {  // with memory: how often it was asked in this run
  int calls = 0;
  void reset() { calls = 0; }
  Action operator()(const State&) { return Action(++calls); }
};

struct Forgetful {  // changes itself, but cannot be reset
  int calls = 0;
  Action operator()(const State&) { return Action(++calls); }
};

struct OtherAction {
  Vec<3> operator()(const State&) const { return Vec<3>::Zero(); }
};

struct NotCopyable {
  NotCopyable() = default;
  NotCopyable(const NotCopyable&) = delete;
  Action operator()(const State&) const { return Action(1.0); }
};

TEST_CASE("functions, lambdas and structs of the right shape are policies; others are not") {
  constexpr auto lambda = [](const State& state) -> Action { return -state.head<1>(); };
  static_assert(MemorylessPolicy<decltype(lambda), DoubleIntegrator>);
  static_assert(Policy<Action (*)(const State&), DoubleIntegrator>);
  static_assert(PolicyWithMemory<Counter, DoubleIntegrator>);
  static_assert(PolicyWithMemory<RandomPolicy<1>, DoubleIntegrator>);
  static_assert(!Policy<Forgetful, DoubleIntegrator>);
  static_assert(!Policy<OtherAction, DoubleIntegrator>);
  static_assert(!Policy<Counter, int>);
  CHECK(lambda(State(2, 0)) == Action(-2.0));
}

TEST_CASE("a policy with memory starts each run reset, on a copy") {
  Counter counter;
  counter(State::Zero());
  auto fresh = start_of_run<DoubleIntegrator>(counter, Rng(1));
  CHECK(fresh(State::Zero())[0] == 1);
  CHECK(counter.calls == 1);
}

TEST_CASE("a policy without memory is used as it is, never copied") {
  const NotCopyable policy;
  auto&& used = start_of_run<DoubleIntegrator>(policy, Rng(1));
  CHECK(&used == &policy);
}

TEST_CASE("random actions lie in their box, differ between runs and repeat with the run's seed") {
  const Box<1> box(Action(2.0), Action(3.0));
  const RandomPolicy<1> policy(box);
  auto one = start_of_run<DoubleIntegrator>(policy, Rng(1));
  auto same = start_of_run<DoubleIntegrator>(policy, Rng(1));
  auto other = start_of_run<DoubleIntegrator>(policy, Rng(2));
  Action last(0.0);
  for (int i = 0; i < 20; ++i) {
    const Action action = one(State::Zero());
    CHECK(box.contains(action));
    CHECK(action != last);
    CHECK(action == same(State::Zero()));
    CHECK(action != other(State::Zero()));
    last = action;
  }
}

}  // namespace
}  // namespace surefoot

// A problem and a policy of which WRONG_<member>, defined on the command line, spoils one member; RFPI, VALIDATE,
// COMPARE or EVALUATE says which algorithm is given them.
#if defined(RFPI)
#include "surefoot/solve/rfpi.hpp"
#elif defined(VALIDATE)
#include "surefoot/core/validate.hpp"
#else
#include "surefoot/core/rollout.hpp"
#endif

struct Mine {
#if !defined(WRONG_state_dim)
  static constexpr int state_dim = 2;
#endif
#if !defined(WRONG_action_dim)
  static constexpr int action_dim = 1;
#endif
#if !defined(WRONG_State)
  using State = surefoot::Vec<2>;
#else
  using State = surefoot::Vec<3>;
#endif
#if !defined(WRONG_Action)
  using Action = surefoot::Vec<1>;
#else
  using Action = double;
#endif
#if !defined(WRONG_state_box)
  surefoot::Box<2> state_box() const { return surefoot::Box<2>::symmetric(surefoot::Vec<2>(1, 1)); }
#endif
#if !defined(WRONG_action_box)
  surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(surefoot::Vec<1>(1.0)); }
#else
  surefoot::Box<2> action_box() const { return surefoot::Box<2>::symmetric(surefoot::Vec<2>(1, 1)); }
#endif
#if !defined(WRONG_initial_state)
  State initial_state(surefoot::Rng&) const { return State::Zero(); }
#else
  State initial_state() const { return State::Zero(); }
#endif
#if defined(FEATURES)
  static constexpr int feature_dim = FEATURES;
#endif
#if defined(FEATURES) || defined(WRONG_features)
  surefoot::Vec<3> features(const State& state) const { return {state[0], state[1], 1}; }
#endif
#if defined(WRONG_step) && WRONG_step == 1  // without Rng
  surefoot::Step<State> step(const State& state, const Action&) const { return {state, 0, false}; }
#elif defined(WRONG_step) && WRONG_step == 2  // not const
  surefoot::Step<State> step(const State& state, const Action&, surefoot::Rng&) { return {state, 0, false}; }
#elif defined(WRONG_step) && WRONG_step == 3  // another result
  double step(const State& state, const Action&, surefoot::Rng&) const { return state[0]; }
#elif !defined(WRONG_step)
  surefoot::Step<State> step(const State& state, const Action&, surefoot::Rng&) const { return {state, 0, false}; }
#endif
};

struct MyPolicy {
#if defined(WRONG_call_operator)
  double operator()(const Mine::State& state) const { return state[0]; }
#elif defined(WRONG_reset)
  Mine::Action operator()(const Mine::State&) { return Mine::Action(0.0); }
#else
  Mine::Action operator()(const Mine::State&) const { return Mine::Action(0.0); }
#endif
};

int main() {
#if defined(RFPI)
  const auto result = surefoot::rfpi(Mine{}, {.budget = {.counted_seconds = 300}}, surefoot::Threads{}, 1);
  return result.policy(Mine::State::Zero())[0] > 0;
#elif defined(VALIDATE)
  const auto complaints = surefoot::validate(Mine{});
  return complaints.empty();
#elif defined(COMPARE)
  const auto difference = surefoot::compare(Mine{}, MyPolicy{}, MyPolicy{}, {.runs = 10}, surefoot::Threads{}, 1);
  return difference.mean > difference.half_width();
#else
  const auto value = surefoot::evaluate(Mine{}, MyPolicy{}, {.runs = 10}, surefoot::Threads{}, 1);
  return value.mean > value.half_width();
#endif
}

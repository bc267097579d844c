// The concept of a policy: what chooses an action in a state.
#pragma once

#include <concepts>
#include <cstdint>
#include <utility>

#include "surefoot/core/box.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"

namespace surefoot {

/// A policy of problem P maps a state to an action, of exactly the type P::Action. Two shapes conform:
///
///   Action operator()(const State&) const;     // without memory: a function, a lambda, a forest
///   Action operator()(const State&);           // with memory (modes, filters): also needs `void reset();` or
///                                              // `void reset(const Rng&);`, called on a copy at the start of every
///                                              // run, the second with a random stream of that run's own
template <class F, class P>
concept MemorylessPolicy = requires(const F& policy, const typename P::State& state) {
  { policy(state) } -> std::same_as<typename P::Action>;
};

template <class F>
concept ResetsWithRng = requires(F& policy, const Rng& rng) { policy.reset(rng); };

template <class F, class P>
concept PolicyWithMemory =
    !MemorylessPolicy<F, P> && std::copyable<F> && requires(F& policy, const typename P::State& state) {
      requires ResetsWithRng<F> || requires { policy.reset(); };
      { policy(state) } -> std::same_as<typename P::Action>;
    };

template <class F, class P>
concept Policy = Problem<P> && (MemorylessPolicy<F, P> || PolicyWithMemory<F, P>);

/// The policy as one run uses it: itself if it has no memory, else a copy without memory of other runs.
/// A policy that draws random numbers gets a stream of the run's `rng` that no transition uses.
template <Problem P, Policy<P> F>
decltype(auto) start_of_run(const F& policy, [[maybe_unused]] const Rng& rng) {
  if constexpr (MemorylessPolicy<F, P>) {
    return (policy);
  } else {
    F fresh = policy;
    if constexpr (ResetsWithRng<F>) {
      fresh.reset(rng.stream(~std::uint64_t{0}));
    } else {
      fresh.reset();
    }
    return fresh;
  }
}

/// As explain_problem(), about the first member that keeps F from being a Policy of the problem P.
template <class F, Problem P>
auto explain_policy() {
  if constexpr (!requires(F& policy, const typename P::State& state) {
                  { policy(state) } -> std::same_as<typename P::Action>;
                }) {
    return Incomplete<F>::call_operator;  // Action operator()(const State&) const
  } else {
    return Incomplete<F>::reset;  // void reset(), or operator()(const State&) const if the policy has no memory
  }
}

/// Uniformly random actions, other ones in every run: the first policy of everything that learns from nothing.
template <int ActionDim>
class RandomPolicy {
 public:
  explicit RandomPolicy(Box<ActionDim> box, Rng rng = Rng(0)) : box_(std::move(box)), rng_(rng) {}
  void reset(const Rng& rng) { rng_ = rng; }
  template <class State>
  Vec<ActionDim> operator()(const State&) {
    return box_.sample(rng_);
  }

 private:
  Box<ActionDim> box_;
  Rng rng_;
};

}  // namespace surefoot

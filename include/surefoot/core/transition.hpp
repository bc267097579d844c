// The concept of a transition model: how a state follows another, without rewards. Problems are built around one, so
// that the same problem runs on a textbook model, a calibrated one or a learned one.
#pragma once

#include <concepts>

#include "surefoot/core/rng.hpp"

namespace surefoot {

/// A transition model draws the state that follows `state` under `action`. The smallest conforming struct:
///
///   struct Drift {
///     surefoot::Vec<1> operator()(const surefoot::Vec<1>& position, const surefoot::Vec<1>& speed,
///                                 surefoot::Rng& rng) const {
///       return position + speed + 0.01 * surefoot::Vec<1>(rng.normal());
///     }
///   };
///   static_assert(surefoot::TransitionModel<Drift, surefoot::Vec<1>, surefoot::Vec<1>>);
///
/// A lambda conforms as well. The call must be const, draw all its randomness from the Rng it is given, and be safe
/// from several threads.
template <class M, class State, class Action>
concept TransitionModel = requires(const M& model, const State& state, const Action& action, Rng& rng) {
  { model(state, action, rng) } -> std::same_as<State>;
};

}  // namespace surefoot

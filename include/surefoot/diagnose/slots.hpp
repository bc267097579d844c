// How effects are attached to a run: each wherever it acts, with its parameters and its share of the hidden states.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/diagnose/effect.hpp"
#include "surefoot/diagnose/facts.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace surefoot {

/// Effects with the values of their parameters.
struct Augmentation {
  std::span<const AttachedEffect> effects;
  std::span<const Eigen::VectorXd> values;  // one vector per effect, in units of the model
};

namespace detail {

inline constexpr int most_hidden = 24;

/// Hidden states of all effects of a run, or their rates.
using Hidden = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_hidden, 1>;

/// An effect where it acts.
struct Slot {
  const Effect* effect = nullptr;
  std::size_t number = 0;  // among the effects of the run
  int at = 0, other = -1;  // as in AttachedEffect
  int position = -1;       // the state whose speed it is attached to
  int begin = 0;           // of its hidden states
  Values p = {};           // its parameters
  double size = 1;         // typical, of what it is attached to

  Values hidden(const Hidden& z) const { return {z.data() + begin, static_cast<std::size_t>(effect->memories)}; }
  Memory hidden(Hidden& z) const { return {z.data() + begin, static_cast<std::size_t>(effect->memories)}; }
};

/// The effects of a run by what they do; one that does several things stands in several groups.
struct Slots {
  std::vector<Slot> orders, delays;           // on inputs
  std::vector<Slot> taps;                     // on signals inside the equations; `at` counts from the first signal
  std::vector<Slot> seen;                     // on the positions that the equations see
  std::vector<Slot> forces, dry;              // on rates
  std::vector<Slot> planar, limits, updates;  // once after each step
  std::vector<Slot> drifts;                   // on parameters, once in each row
  std::vector<Slot> sensors;                  // once after the run
  int hidden = 0;                             // count of hidden states
  bool hidden_rates = false;                  // some change within steps, and not only between them
  bool plain_rates = true;                    // are those of the simulator, nothing acts on them
};

inline double size_at(const Sizes& sizes, const Effect& effect, std::size_t at) {
  const std::size_t inputs = sizes.input.size();
  if (effect.place == Place::velocity || effect.place == Place::state) return sizes.state[at];
  if (effect.place != Place::input) return 1;
  return at < inputs ? sizes.input[at] : sizes.signal[at - inputs];
}

/// Throws DiagnoseError if there are too many hidden states.
inline Slots slots_of(const Augmentation& augmentation, const SimulatorInfo& info, const SimulatorFacts& facts,
                      const Sizes& sizes) {
  Slots slots;
  const auto inputs = static_cast<int>(info.inputs.size());
  for (std::size_t i = 0; i < augmentation.effects.size(); ++i) {
    const AttachedEffect& attached = augmentation.effects[i];
    const Effect& effect = *attached.effect;
    const auto at = static_cast<std::size_t>(attached.at);
    const bool on_state = effect.place == Place::velocity || effect.place == Place::state;
    Slot slot{.effect = &effect, .number = i, .at = attached.at, .other = attached.other, .begin = slots.hidden};
    slot.position = on_state ? facts.position_of[at] : -1;
    slot.p = {augmentation.values[i].data(), static_cast<std::size_t>(augmentation.values[i].size())};
    slot.size = size_at(sizes, effect, at);
    slots.hidden += effect.memories;
    if (slots.hidden > most_hidden) {
      throw DiagnoseError("at most 24 hidden states of effects can be simulated at once");
    }
    if (effect.delay && attached.at < inputs) slots.delays.push_back(slot);
    if (effect.signal && attached.at < inputs) slots.orders.push_back(slot);
    if (effect.signal && attached.at >= inputs) {
      slots.taps.push_back(slot);
      slots.taps.back().at -= inputs;
    }
    if (on_state && (effect.force || effect.memory_rate)) slots.forces.push_back(slot);
    if (effect.dry) slots.dry.push_back(slot);
    if (effect.seen_position) slots.seen.push_back(slot);
    if (effect.limit) slots.limits.push_back(slot);
    if (effect.sensor) slots.sensors.push_back(slot);
    if (effect.planar) slots.planar.push_back(slot);
    if (effect.factor) slots.drifts.push_back(slot);
    if (effect.advance || effect.start) slots.updates.push_back(slot);
    slots.hidden_rates = slots.hidden_rates || effect.memory_rate;
  }
  slots.plain_rates =
      slots.orders.empty() && slots.taps.empty() && slots.seen.empty() && slots.forces.empty() && slots.dry.empty();
  return slots;
}

}  // namespace detail

}  // namespace surefoot

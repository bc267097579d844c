// Definitions of surefoot/diagnose/simulation/effect_slots.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/simulation/effect_slots.hpp"
#include "surefoot/diagnose/simulation/structure.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE double size_at(const Sizes& sizes, const Effect& effect, std::size_t at) {
  const std::size_t inputs = sizes.input.size();
  if (effect.place == Place::velocity || effect.place == Place::state) return sizes.state[at];
  if (effect.place != Place::input) return 1;
  return at < inputs ? sizes.input[at] : sizes.signal[at - inputs];
}

SUREFOOT_INLINE EffectSlots assign_slots(const Augmentation& augmentation, const SimulatorInfo& info,
                                         const SimulatorStructure& structure, const Sizes& sizes) {
  EffectSlots slots;
  const auto inputs = static_cast<int>(info.inputs.size());
  for (std::size_t i = 0; i < augmentation.effects.size(); ++i) {
    const AttachedEffect& attached = augmentation.effects[i];
    const Effect& effect = *attached.effect;
    const auto at = static_cast<std::size_t>(attached.at);
    const bool on_state = effect.place == Place::velocity || effect.place == Place::state;
    EffectSlot slot{.effect = &effect, .number = i, .at = attached.at, .other = attached.other, .begin = slots.hidden};
    slot.position = on_state ? structure.position_of[at] : -1;
    const Eigen::VectorXd& values = augmentation.values[i];
    slot.p = {values.data(), std::min(effect.parameters.size(), static_cast<std::size_t>(values.size()))};
    const auto start = static_cast<Eigen::Index>(effect.parameters.size() + augmentation.recording);
    if (effect.starts_anywhere && start < values.size()) slot.start = values[start];
    slot.size = size_at(sizes, effect, at);
    slots.hidden += effect.hidden_states;
    if (slots.hidden > most_hidden) {
      throw DiagnoseError("at most 24 hidden states of effects can be simulated at once");
    }
    const bool on_input = effect.place == Place::input;
    if (on_input && effect.delay && attached.at < inputs) slots.delays.push_back(slot);
    if (on_input && effect.signal && attached.at < inputs) slots.commands.push_back(slot);
    if (on_input && attached.at >= inputs) {
      slots.taps.push_back(slot);
      slots.taps.back().at -= inputs;
    }
    if (on_state && (effect.force || effect.hidden_rate)) slots.forces.push_back(slot);
    if (effect.dry) slots.dry.push_back(slot);
    if (effect.seen_position) slots.seen.push_back(slot);
    if (effect.limit) slots.limits.push_back(slot);
    if (effect.sensor) slots.sensors.push_back(slot);
    if (effect.planar) slots.planar.push_back(slot);
    if (effect.factor) slots.drifts.push_back(slot);
    if (effect.advance || effect.start) slots.updates.push_back(slot);
    slots.hidden_rates = slots.hidden_rates || effect.hidden_rate;
  }
  slots.plain_rates =
      slots.commands.empty() && slots.taps.empty() && slots.seen.empty() && slots.forces.empty() && slots.dry.empty();
  return slots;
}

}  // namespace surefoot::diagnosis

// Effects attached to a run: each wherever it acts, with its parameters and its share of the hidden states.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/simulation/structure.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace surefoot::diagnosis {

/// Effects with the values of their parameters.
struct Augmentation {
  std::span<const AttachedEffect> effects;
  std::span<const Eigen::VectorXd> values;  // one vector per effect, in units of the model (see Hypothesis::values)
  std::size_t recording = 0;                // that is simulated, for what effects begin with
};

inline constexpr int most_hidden = 24;

/// Hidden states of all effects of a run, or their rates.
using Hidden = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_hidden, 1>;

/// An effect where it acts.
struct EffectSlot {
  const Effect* effect = nullptr;
  std::size_t number = 0;  // among the effects of the run
  int at = 0, other = -1;  // as in AttachedEffect
  int position = -1;       // the state whose speed it is attached to
  int begin = 0;           // of its hidden states
  Values p = {};           // its parameters
  double start = 0;        // by which its first hidden state begins off
  double size = 1;         // typical, of what it is attached to

  Values hidden(const Hidden& z) const { return {z.data() + begin, static_cast<std::size_t>(effect->hidden_states)}; }
  HiddenStates hidden(Hidden& z) const { return {z.data() + begin, static_cast<std::size_t>(effect->hidden_states)}; }
};

/// The effects of a run by what they do; one that does several things stands in several groups.
struct EffectSlots {
  std::vector<EffectSlot> commands, delays;  // on inputs
  std::vector<EffectSlot> taps;              // on signals inside the equations; `at` counts from the first signal
  std::vector<EffectSlot> seen;              // on the positions that the equations see
  std::vector<EffectSlot> forces, dry;       // on rates
  std::vector<EffectSlot> planar, limits, updates;  // once after each step
  std::vector<EffectSlot> drifts;                   // on parameters, once in each row
  std::vector<EffectSlot> sensors;                  // once after the run
  int hidden = 0;                                   // count of hidden states
  bool hidden_rates = false;                        // some change within steps, and not only between them
  bool plain_rates = true;                          // are those of the simulator, nothing acts on them
};

double size_at(const Sizes& sizes, const Effect& effect, std::size_t at);

/// Throws DiagnoseError if there are too many hidden states.
EffectSlots assign_slots(const Augmentation& augmentation, const SimulatorInfo& info,
                         const SimulatorStructure& structure, const Sizes& sizes);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/simulation/effect_slots.ipp"
#endif

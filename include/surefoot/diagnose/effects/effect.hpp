// Effect: one piece of physics that a simulator may have left out. A value: what it is called, which parameters it
// has, where it may attach, and what it does there. The library's own stand in effects/, one file each; users make
// theirs the same way and hand them to diagnose() among the others.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/pose2.hpp"

namespace surefoot {

/// Where an effect attaches.
enum class Place : std::uint8_t {
  velocity,   // a state of an ODE that is the speed of something; the effect is a force on it
  state,      // any state; the effect adds to its rate (map: to its next value)
  input,      // an input or a signal inside the equations, on its way to the machine
  output,     // a sensor
  planar,     // the displacement of a step in the plane (maps with a pose)
  parameter,  // a parameter that does not stay the same
};

/// Powers of the natural measures at the place of attachment; the measure of a parameter is their product. `value`
/// belongs to the thing attached to (velocity or state, input, output, parameter), `position` to what a velocity is the
/// speed of, `effort` to the force on it, `rate` to what this force changes, `time` is that of 200 rows.
struct Measure {
  int effort = 0, value = 0, position = 0, time = 0, rate = 0;
};

/// A parameter of an effect. Bounds and starting values are multiples of the typical size of its measure in the
/// recordings, so that they need not be chosen for each machine.
struct EffectParameter {
  std::string name;
  Measure measure = {};
  double low = 0, high = 1;
  std::vector<double> starts;  // tried in turn, in every combination; for a strength: a small but visible one
  bool strength = false;       // the effect vanishes, in proportion, as this goes to 0
  bool of_peak = false;        // starts are shares of the largest value in the recordings instead (levels that clip)
  bool beyond_least = false;   // starts are shares of the way from the input's least value other than 0 to that size
};

/// What an effect may look at in a context of a simulation. Units are those of the model.
struct EffectContext {
  double time = 0;      // since the first row [s], or steps
  double step = 0;      // of the integration [s], or 1
  double value = 0;     // of the state or signal it is attached to, without the effect
  double position = 0;  // what `value` is the speed of; 0 if that is no state
  double rate = 0;      // of the state it is attached to, as the simulator has it
  double effort = 1;    // what turns this rate into a force or torque
  double drive = 0;     // force due to the inputs, if the effect asks for it (needs_drive)
  double load = 0;      // force that remains with inputs and speed at zero, likewise (needs_load)
  double damping = 0;   // by how much the force falls per unit of `value` (needs_damping)
};

using Values = std::span<const double>;
using HiddenStates = std::span<double>;

/// A sensor's readings at the rows of a recording, to be changed in place.
struct Series {
  Values time;  // [s], or steps
  std::span<double> readings;
};

/// What an effect is and does. Only the functions that it needs are set; p are its parameters in their order, `hidden`
/// its hidden states. The catalogue writes them +[](...): plain functions, which cost the compiler far less memory than
/// closures of a type each; where something is captured, a closure does as well.
struct Effect {
  std::string name;
  std::string sentence =
      {};  // for people; "{level}" stands for the parameter of that name with its unit, "{at}" for the place
  Place place = Place::velocity;
  std::vector<EffectParameter> parameters = {};
  std::vector<std::string> confusable_with = {};  // names of effects with a similar signature
  std::string experiment = {};                    // that shows this effect by itself
  std::string form = {};                          // tells variants of one name apart, mostly empty
  std::vector<std::string> extends = {};          // forms that are special cases of it; it is only tried where one of
                                                  // them was found, from its fit and the starts of its other parameters

  int hidden_states = 0;
  std::optional<Measure> start_measure = {};  // of the first hidden state, where a recording may find it at any value
  bool starts_anywhere = false;  // and does: what `start` says is off by a number that each recording tells
  bool needs_drive = false;
  bool needs_load = false;
  bool needs_damping = false;
  bool is_impulsive =
      false;              // its signature does not grow in proportion: starts are ranked as they are, and not scaled
  bool needs_angle = false;  // says nothing of a velocity that is not the speed of an angle
  bool needs_turns = false;  // says something only of an angle [rad] that goes further than half a turn to a side
  bool needs_both_signs = false;  // of an input or signal that never changes its sign it says no more than others do
  bool needs_small_values =
      false;                    // of an input or signal that is large or 0 its soft edge would tell, and nothing else
  bool needs_coupling = false;  // of a signal: it holds bodies together, and depends on their states alone
  std::string needs_unit = {};  // of the velocity it is attached to
  bool from_rest = false;    // what it is attached to was 0 before the first row, and not as in it (Place::input)
  bool at_start = false;  // a sensor's fault that an initial state read off that sensor has, too
  bool needs_conserved_state =
      false;  // needs a state of which there is more or less (Place::state): no angle, and rates depend on it
  bool needs_suggestion = false;     // is not tried unless readings suggest where (suggest)
  bool rounds = false;               // readings, to steps: what is inside of a step tells no fit which way to go
  bool is_constant = false;          // has a size and no form: nothing that another effect could mend
  bool has_overflow_target = false;  // also tried with each other state as `other` (limit)

  /// Force on a velocity, in effort units; for Place::state the addition to the rate.
  std::function<double(const EffectContext&, Values p, Values hidden)> force = {};
  /// Addition to the rate of what a velocity is the speed of: where is_impulsive within a step move it otherwise than
  /// their mean force does.
  std::function<double(const EffectContext&, Values p, Values hidden)> position_rate = {};
  /// Level of dry friction, at least 0: the force that holds the velocity at zero, or opposes it.
  std::function<double(const EffectContext&, Values p)> dry = {};
  /// Beside `dry`, where that creeps instead of holding: how fast, by the share of its level (-1 to 1) that would hold.
  double (*creep)(double share, Values p) = nullptr;
  /// Hidden states: values at the start (zero without this), rates, and what is done once after each step.
  std::function<void(const EffectContext&, Values p, HiddenStates hidden)> start = {};
  /// Where the first hidden state starts anywhere: keeps it to what it can be.
  std::function<void(Values p, HiddenStates hidden)> limit_start = {};
  std::function<void(const EffectContext&, Values p, Values hidden, HiddenStates rates)> hidden_rate = {};
  std::function<void(const EffectContext&, Values p, HiddenStates hidden)> advance = {};
  /// What becomes of an input or a signal.
  std::function<double(const EffectContext&, Values p, Values hidden)> signal = {};
  /// Delay of an input or a signal [s, or steps]. Beside `sensor`: how old its readings are, so that an initial state
  /// is read off a later one.
  std::function<double(Values p)> delay = {};
  /// Starting values of the first parameter, in place of `starts`, that readings suggest: those of the sensor attached
  /// to, or of one that reads the state attached to (for a velocity: what it is the speed of).
  /// Beside each reading stands what was simulated without the effect.
  std::function<std::vector<double>(Values readings, Values simulated)> suggest = {};
  /// What position the equations see, for Place::velocity.
  std::function<double(const EffectContext&, Values p, Values hidden)> seen_position = {};
  /// After each step: the state attached to, what it is the speed of, and for effects that overflow into another state.
  std::function<void(Values p, double& value, double& position, double& other)> limit = {};
  /// What a sensor reads.
  std::function<void(const Series&, Values p)> sensor = {};
  /// Displacement of a step from one pose (its heading is in the world) [m, m, rad].
  std::function<Pose2(const Pose2& displacement, double heading, Values p)> planar = {};
  /// Factor of a parameter.
  std::function<double(const EffectContext&, Values p)> factor = {};
};

/// Throws a DiagnoseError that names the effect and the first thing that cannot be: no name, no function that its place
/// calls, one that it never calls, parameters without bounds or starting values, hidden states that nothing changes.
void check(const Effect& effect);

/// Limits of a parameter of an effect, in the unit of the model; NaN: those of the library. Equal: it is not fitted.
struct EffectBounds {
  double low = std::numeric_limits<double>::quiet_NaN(), high = low;
};

/// An effect at its place in one simulator.
struct AttachedEffect {
  std::shared_ptr<const Effect> effect;
  int at = 0;         // index of the state, of the input (signals follow the inputs), of the output or of the parameter
  int other = -1;     // another state, for effects that overflow into it
  std::string place;  // the name of what it is attached to
  int rank = 0;       // of the effect in the catalogue, which begins with the simplest
  std::vector<EffectBounds> bounds = {};  // of its parameters, as given with it; empty: those of the effect

  std::string label() const { return effect->name + " at " + place; }
};

/// The same name at the same place.
inline bool same_but_for_form(const AttachedEffect& a, const AttachedEffect& b) {
  return a.effect->name == b.effect->name && a.at == b.at && a.effect->place == b.effect->place;
}

inline bool same_effect(const AttachedEffect& a, const AttachedEffect& b) {
  return a.effect->name == b.effect->name && a.effect->form == b.effect->form && a.at == b.at && a.other == b.other &&
         a.effect->place == b.effect->place;
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/effects/effect.ipp"
#endif

// Definitions of surefoot/diagnose/effects/catalogue.hpp.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/effects/backlash.hpp"
#include "surefoot/diagnose/effects/body_drift.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/cogging.hpp"
#include "surefoot/diagnose/effects/constant_force.hpp"
#include "surefoot/diagnose/effects/constant_rate.hpp"
#include "surefoot/diagnose/effects/coulomb_friction.hpp"
#include "surefoot/diagnose/effects/cross_coupling.hpp"
#include "surefoot/diagnose/effects/cubic_stiffness.hpp"
#include "surefoot/diagnose/effects/dead_zone.hpp"
#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/effects/end_stop.hpp"
#include "surefoot/diagnose/effects/first_order_lag.hpp"
#include "surefoot/diagnose/effects/from_rest.hpp"
#include "surefoot/diagnose/effects/gravity_offset.hpp"
#include "surefoot/diagnose/effects/ground_slope.hpp"
#include "surefoot/diagnose/effects/hysteresis.hpp"
#include "surefoot/diagnose/effects/input_asymmetry.hpp"
#include "surefoot/diagnose/effects/input_delay.hpp"
#include "surefoot/diagnose/effects/input_gain.hpp"
#include "surefoot/diagnose/effects/joint_elasticity.hpp"
#include "surefoot/diagnose/effects/leak.hpp"
#include "surefoot/diagnose/effects/load_dependent_friction.hpp"
#include "surefoot/diagnose/effects/not_settled.hpp"
#include "surefoot/diagnose/effects/overflow.hpp"
#include "surefoot/diagnose/effects/parameter_drift.hpp"
#include "surefoot/diagnose/effects/quadratic_drag.hpp"
#include "surefoot/diagnose/effects/quantization.hpp"
#include "surefoot/diagnose/effects/rate_limit.hpp"
#include "surefoot/diagnose/effects/saturation.hpp"
#include "surefoot/diagnose/effects/sensor_bias.hpp"
#include "surefoot/diagnose/effects/sensor_delay.hpp"
#include "surefoot/diagnose/effects/sensor_drift.hpp"
#include "surefoot/diagnose/effects/sensor_scale.hpp"
#include "surefoot/diagnose/effects/slip_saturation.hpp"
#include "surefoot/diagnose/effects/smooth_friction.hpp"
#include "surefoot/diagnose/effects/stribeck_friction.hpp"
#include "surefoot/diagnose/effects/supply_sag.hpp"
#include "surefoot/diagnose/effects/viscous_friction.hpp"

namespace surefoot {

/// The effects that these functions make. (A list of effects would cost the compiler code that clears up each of them.)
SUREFOOT_ONCE std::vector<Effect> made_by(std::initializer_list<Effect (*)()> functions) {
  std::vector<Effect> effects;
  effects.reserve(functions.size());
  for (const auto make : functions) effects.push_back(make());
  return effects;
}

SUREFOOT_ONCE std::vector<Effect> velocity_effects() {
  std::vector<Effect> all = made_by({effects::viscous_friction,
                                     effects::coulomb_friction,
                                     effects::coulomb_friction_presliding,
                                     effects::coulomb_friction_damped,
                                     effects::stribeck_friction,
                                     effects::stribeck_friction_tailed,
                                     effects::load_dependent_friction,
                                     effects::load_dependent_friction_under_load,
                                     effects::load_dependent_friction_in_gears,
                                     effects::load_dependent_friction_on_both_sides,
                                     effects::quadratic_drag,
                                     effects::constant_force,
                                     effects::cubic_stiffness,
                                     effects::cubic_stiffness_off_center,
                                     effects::hysteresis,
                                     effects::hysteresis_squared,
                                     effects::hysteresis_asymmetric,
                                     effects::hysteresis_general,
                                     effects::backlash,
                                     effects::backlash_gap,
                                     effects::backlash_motor,
                                     effects::joint_elasticity,
                                     effects::joint_elasticity_two_modes,
                                     effects::cogging,
                                     effects::cogging_harmonics,
                                     effects::cogging_per_turn,
                                     effects::gravity_offset,
                                     effects::end_stop_upper,
                                     effects::end_stop_lower,
                                     [] { return effects::elastic_end_stop(true); },
                                     [] { return effects::elastic_end_stop(false); }});
  for (std::size_t i = 0, count = all.size(); i < count; ++i) {
    if (!all[i].dry) continue;
    const bool of_load = all[i].needs_drive || all[i].needs_load;  // has many forms, each of which would be fitted
    if (!of_load) all.push_back(effects::creeping(all[i]));
    if (all[i].form == "tailed") continue;
    if (of_load) {
      const Effect presliding = effects::with_presliding(all[i]);
      all.push_back(presliding);
      if (all[i].extends.empty()) all.push_back(effects::damped(presliding, all[i]));
    }
    all.push_back(effects::smoothed(all[i]));
  }
  all.push_back(effects::with_presliding(effects::stribeck_friction()));
  all.back().extends = {"", "smooth"};
  all.push_back(effects::damped(effects::with_presliding(effects::stribeck_friction()), effects::stribeck_friction()));
  return all;
}

SUREFOOT_ONCE std::vector<Effect> input_effects() {
  std::vector<Effect> all =
      made_by({effects::input_gain, effects::input_asymmetry, effects::dead_zone, effects::dead_zone_step,
               effects::saturation, effects::saturation_soft, effects::saturation_gradual, effects::rate_limit,
               effects::input_delay, effects::first_order_lag, effects::second_order_lag, effects::supply_sag,
               effects::backlash_coupling, effects::cubic_stiffness_coupling});
  for (std::size_t i = 0, count = all.size(); i < count; ++i) {
    if (all[i].start || all[i].delay) all.push_back(effects::from_rest(all[i]));
  }
  return all;
}

SUREFOOT_ONCE std::vector<Effect> planar_effects() {
  return made_by({effects::slip_saturation_forward, effects::slip_saturation_lateral, effects::slip_saturation_turn,
                  effects::body_drift, effects::ground_slope, effects::ground_slope_distance,
                  effects::cross_coupling_forward_to_turn, effects::cross_coupling_forward_to_lateral,
                  effects::cross_coupling_lateral_to_turn, effects::cross_coupling_lateral_to_forward,
                  effects::cross_coupling_turn_to_forward, effects::cross_coupling_turn_to_lateral});
}

SUREFOOT_ONCE std::vector<Effect> all_effects() {
  std::vector<Effect> all;
  for (const auto group :
       {planar_effects, velocity_effects, state_effects, input_effects, sensor_effects, parameter_effects}) {
    for (const Effect& effect : group()) all.push_back(effect);
  }
  all.push_back(effects::supply_sag_current());  // a form of an effect on inputs
  for (std::size_t i = 0, count = all.size(); i < count; ++i) {
    if (all[i].start_measure && !all[i].from_rest) all.push_back(effects::not_settled(all[i]));
  }
  return all;
}

SUREFOOT_ONCE std::vector<Effect> state_effects() {
  return made_by({effects::leak, effects::leak_hole, effects::leak_power, effects::constant_rate, effects::overflow,
                  effects::overflow_spill, effects::overflow_weir});
}

SUREFOOT_ONCE std::vector<Effect> sensor_effects() {
  return made_by({effects::sensor_bias, effects::sensor_scale, effects::sensor_delay, effects::sensor_delay_in_motion,
                  effects::sensor_drift, effects::sensor_drift_settling, effects::sensor_drift_bent,
                  effects::sensor_drift_midway, effects::quantization, effects::quantization_floor,
                  [] { return effects::sharpened(effects::quantization()); },
                  [] { return effects::sharpened(effects::quantization_floor()); }, effects::backlash_sensor});
}

SUREFOOT_ONCE std::vector<Effect> parameter_effects() {
  return made_by({effects::parameter_drift, effects::parameter_drift_settling, effects::parameter_drift_bent,
                  effects::parameter_drift_midway});
}

}  // namespace surefoot

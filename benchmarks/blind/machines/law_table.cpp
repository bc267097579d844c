#include "law_table.hpp"

#include <map>
#include <vector>

namespace machines {
namespace {

// A law for an effect: as the library has it, otherwise, or otherwise and for examinations alone.
struct Laws {
  std::vector<Law> same, other, own;
};

const std::map<std::string, Laws>& laws() {
  static const std::map<std::string, Laws> table{
      {"viscous_friction", {{Law::viscous}, {}, {}}},
      {"coulomb_friction",
       {{Law::bristles}, {Law::soft_bristles, Law::smooth_dry, Law::arctan_dry}, {Law::rational_dry}}},
      {"stribeck_friction", {{Law::stribeck_gauss}, {Law::stribeck_exponential}, {Law::stribeck_lorentz}}},
      {"load_dependent_friction", {{}, {Law::load_bristles}, {}}},
      {"quadratic_drag", {{Law::square_drag}, {Law::power_drag}, {}}},
      {"constant_force", {{Law::constant}, {}, {}}},
      {"cubic_stiffness", {{Law::cubic}, {Law::sinh_spring}, {Law::tangent_spring}}},
      {"hysteresis", {{Law::dahl}, {Law::square_hysteresis}, {}}},
      {"backlash", {{Law::seen_backlash}, {Law::load_behind_gap}, {}}},
      {"joint_elasticity", {{Law::resonator}, {Law::two_resonators}, {}}},
      {"end_stop", {{Law::hard_stop}, {Law::elastic_stop}, {}}},
      {"cogging", {{Law::sine_cogging}, {Law::triangle_cogging}, {Law::two_wave_cogging}}},
      {"gravity_offset", {{Law::weight_offset}, {}, {}}},
      {"leak", {{Law::leak}, {Law::hole, Law::power_leak}, {Law::raised_hole}}},
      {"constant_rate", {{Law::rate}, {}, {}}},
      {"overflow", {{Law::overflow}, {Law::weir}, {}}},
      {"input_gain", {{Law::gain}, {}, {}}},
      {"input_asymmetry", {{Law::asymmetry}, {}, {}}},
      {"dead_zone", {{Law::dead_zone}, {Law::dead_step}, {}}},
      {"saturation", {{Law::clip}, {Law::smooth_clip}, {Law::tanh_clip}}},
      {"rate_limit", {{Law::rate_limit}, {}, {}}},
      {"input_delay", {{Law::delay}, {}, {}}},
      {"first_order_lag", {{Law::lag}, {Law::second_lag, Law::third_lag}, {Law::fourth_lag}}},
      {"supply_sag", {{Law::sag}, {}, {}}},
      {"sensor_bias", {{Law::bias}, {}, {}}},
      {"sensor_scale", {{Law::scale}, {}, {}}},
      {"sensor_delay", {{Law::sensor_delay}, {}, {}}},
      {"sensor_drift", {{Law::drift}, {Law::warm_drift}, {}}},
      {"quantization", {{Law::round_off}, {Law::floor_off}, {}}},
      {"parameter_drift",
       {{Law::linear_drift}, {Law::warm_up, Law::late_drift, Law::midway_drift}, {Law::passing_drift}}},
      {"gusts", {{}, {Law::gusts}, {}}},
      {"asymmetric_damping", {{}, {Law::asymmetric_damping}, {}}},
      {"heat_fade", {{}, {}, {Law::heat_fade}}},
      {"detent", {{}, {Law::detent}, {}}},
      {"sticky_patch", {{}, {Law::sticky_patch}, {}}},
      {"growing_inertia", {{}, {Law::growing_inertia}, {}}},
      {"weak_zone", {{}, {Law::weak_zone}, {}}},
      {"ripple", {{}, {Law::ripple}, {}}},
      {"choke", {{}, {Law::choke}, {}}},
      {"exchange", {{}, {Law::exchange}, {}}},
      {"radiation", {{}, {}, {Law::radiation}}},
      {"uneven_gain", {{}, {Law::uneven_gain}, {}}},
      {"gain_ripple", {{}, {Law::gusts}, {}}},
      {"ageing", {{}, {}, {Law::ageing}}}};
  return table;
}

// The sentences of what is outside the library.
const std::map<std::string, std::string>& outside_names() {
  static const std::map<std::string, std::string> table{
      {"gusts", "outside: periodic disturbance in time"},
      {"asymmetric_damping", "outside: damping that differs with the direction"},
      {"heat_fade", "outside: drive that fades with heat and recovers"},
      {"detent", "outside: detent near one position"},
      {"sticky_patch", "outside: thick resistance near one position"},
      {"growing_inertia", "outside: inertia that grows away from the middle"},
      {"weak_zone", "outside: drive that fades in a stretch of positions"},
      {"ripple", "outside: periodic disturbance in time"},
      {"choke", "outside: outlet that chokes below a level"},
      {"exchange", "outside: exchange that swings with time"},
      {"radiation", "outside: loss by radiation"},
      {"uneven_gain", "outside: gain that goes up and down with the input"},
      {"gain_ripple", "outside: gain that swings with time"},
      {"ageing", "outside: input that fades with use"}};
  return table;
}

}  // namespace

Law draw_law(Random& random, const Grammar& grammar, const Candidate& candidate, bool& same) {
  same = true;
  if (candidate.where == Where::link) return Law::dead_zone;
  if (candidate.name == "backlash" && candidate.where == Where::sensor) return Law::sensor_backlash;
  const Laws& known = laws().at(candidate.name);
  if (!known.own.empty() && (grammar.draw_own(random) || (known.same.empty() && known.other.empty()))) {
    same = false;
    return random.choice(known.own);
  }
  same = !known.same.empty() && (known.other.empty() || random.chance(0.4));
  return random.choice(same ? known.same : known.other);
}

bool is_open(const Grammar& grammar, const Candidate& candidate) {
  const Laws& known = laws().at(candidate.name);
  return grammar.examination || !known.same.empty() || !known.other.empty();
}

std::string full_name(const std::string& name) {
  const auto outside = outside_names().find(name);
  return outside == outside_names().end() ? name : outside->second;
}

std::string name_of_strength(const std::string& name) {
  static const std::map<std::string, std::string> table{{"viscous_friction", "damping"},
                                                        {"load_dependent_friction", "factor"},
                                                        {"quadratic_drag", "drag"},
                                                        {"constant_force", "force"},
                                                        {"cubic_stiffness", "stiffness"},
                                                        {"hysteresis", "force"},
                                                        {"backlash", "half_width"},
                                                        {"joint_elasticity", "ratio"},
                                                        {"cogging", "amplitude"},
                                                        {"gravity_offset", "weight"},
                                                        {"leak", "leak"},
                                                        {"constant_rate", "rate"},
                                                        {"input_gain", "excess"},
                                                        {"input_asymmetry", "asymmetry"},
                                                        {"dead_zone", "width"},
                                                        {"rate_limit", "rate"},
                                                        {"input_delay", "delay"},
                                                        {"first_order_lag", "time"},
                                                        {"supply_sag", "sag"},
                                                        {"sensor_bias", "bias"},
                                                        {"sensor_scale", "excess"},
                                                        {"sensor_delay", "delay"},
                                                        {"sensor_drift", "rate"},
                                                        {"quantization", "step"},
                                                        {"parameter_drift", "rate"}};
  const auto at = table.find(name);
  return at == table.end() ? "level" : at->second;
}

}  // namespace machines

#include "draw_effects.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace machines {
namespace {

constexpr double circle = 2 * std::numbers::pi;

// A law for an effect: as the library has it, otherwise, or otherwise and for examinations alone.
struct Laws {
  std::vector<Law> same, other, own;
};

const std::map<std::string, Laws>& laws() {
  static const std::map<std::string, Laws> table{
      {"viscous_friction", {{Law::viscous}, {}, {}}},
      {"coulomb_friction", {{Law::bristles}, {Law::soft_bristles, Law::smooth_dry}, {Law::arctan_dry}}},
      {"stribeck_friction", {{Law::stribeck_gauss}, {Law::stribeck_exponential}, {Law::stribeck_lorentz}}},
      {"load_dependent_friction", {{}, {Law::load_bristles}, {}}},
      {"quadratic_drag", {{Law::square_drag}, {Law::power_drag}, {}}},
      {"constant_force", {{Law::constant}, {}, {}}},
      {"cubic_stiffness", {{Law::cubic}, {Law::sinh_spring}, {Law::tangent_spring}}},
      {"hysteresis", {{Law::dahl}, {Law::square_hysteresis}, {}}},
      {"backlash", {{Law::seen_backlash}, {Law::load_behind_gap}, {}}},
      {"joint_elasticity", {{Law::resonator}, {}, {}}},
      {"end_stop", {{Law::hard_stop}, {Law::elastic_stop}, {}}},
      {"cogging", {{Law::sine_cogging}, {Law::triangle_cogging}, {Law::two_wave_cogging}}},
      {"gravity_offset", {{Law::weight_offset}, {}, {}}},
      {"leak", {{Law::leak}, {Law::hole}, {Law::power_leak}}},
      {"constant_rate", {{Law::rate}, {}, {}}},
      {"overflow", {{Law::overflow}, {Law::weir}, {}}},
      {"input_gain", {{Law::gain}, {}, {}}},
      {"input_asymmetry", {{Law::asymmetry}, {}, {}}},
      {"dead_zone", {{Law::dead_zone}, {Law::dead_step}, {}}},
      {"saturation", {{Law::clip}, {Law::smooth_clip}, {Law::tanh_clip}}},
      {"rate_limit", {{Law::rate_limit}, {}, {}}},
      {"input_delay", {{Law::delay}, {}, {}}},
      {"first_order_lag", {{Law::lag}, {}, {Law::second_lag}}},
      {"supply_sag", {{Law::sag}, {}, {}}},
      {"sensor_bias", {{Law::bias}, {}, {}}},
      {"sensor_scale", {{Law::scale}, {}, {}}},
      {"sensor_delay", {{Law::sensor_delay}, {}, {}}},
      {"sensor_drift", {{Law::drift}, {Law::warm_drift}, {}}},
      {"quantization", {{Law::round_off}, {Law::floor_off}, {}}},
      {"parameter_drift", {{Law::linear_drift}, {Law::warm_up}, {Law::late_drift}}},
      {"gusts", {{}, {Law::gusts}, {}}},
      {"asymmetric_damping", {{}, {Law::asymmetric_damping}, {}}},
      {"heat_fade", {{}, {}, {Law::heat_fade}}},
      {"detent", {{}, {Law::detent}, {}}},
      {"sticky_patch", {{}, {Law::sticky_patch}, {}}},
      {"growing_inertia", {{}, {Law::growing_inertia}, {}}},
      {"two_resonators", {{}, {Law::two_resonators}, {}}},
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
      {"two_resonators", "outside: two further resonances"},
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

// For states of their own law on sensors, links and signals.
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

double graded(Random& random, double low, double high) { return random.log_uniform(low / 3, high); }

class Drawing {
 public:
  Drawing(Random& random, const Machine& machine, const Sizes& sizes, const std::vector<double>& noise)
      : random_(random), machine_(machine), sizes_(sizes), noise_(noise) {}

  void force(Hidden& one) {
    const auto s = static_cast<std::size_t>(one.target);
    const int p = machine_.states[s].position;
    const double force = sizes_.forces[s], speed = sizes_.states[s].rms;
    const Size position = p < 0 ? Size{} : sizes_.states[static_cast<std::size_t>(p)];
    switch (one.law) {
      case Law::viscous:
        one.a = graded(random_, 0.1, 0.8) * force / speed;
        break;
      case Law::asymmetric_damping:
        one.a = graded(random_, 0.2, 1) * force / speed, one.b = random_.uniform(0, 0.3);
        break;
      case Law::square_drag:
      case Law::power_drag:
        one.b = one.law == Law::square_drag ? 2 : 1.8;
        one.a = graded(random_, 0.1, 0.8) * force / std::pow(speed, one.b);
        break;
      case Law::load_bristles:
        one.a = graded(random_, 0.06, 0.35);
        one.b = machine_.states[s].load.empty() ? 0 : static_cast<double>(random_.index(2));
        break;
      case Law::constant:
      case Law::weight_offset:
        one.a = random_.sign() * graded(random_, 0.05, 0.4) * force;
        break;
      case Law::gusts:
        one.a = graded(random_, 0.2, 0.8) * force;
        one.b = machine_.time_scale * random_.uniform(0.7, 4), one.c = random_.uniform(0, circle);
        break;
      case Law::heat_fade:
        one.a = graded(random_, 0.3, 0.8), one.b = force, one.c = sizes_.duration * random_.uniform(0.2, 1);
        break;
      default:
        if (p < 0 || !positional(one, force, speed, position)) dry(one, force, speed);
    }
  }

  void other_state(Hidden& one, std::size_t count) {
    const Size& size = sizes_.states[static_cast<std::size_t>(one.target)];
    const double rate = size.rate, peak = size.high, period = machine_.time_scale * random_.uniform(0.7, 4);
    one.c = random_.uniform(0, circle);
    switch (one.law) {
      case Law::leak:
        one.a = graded(random_, 0.05, 0.5) * rate / size.rms;
        break;
      case Law::hole:
        one.a = graded(random_, 0.05, 0.5) * rate / std::sqrt(size.rms);
        break;
      case Law::power_leak:
        one.a = graded(random_, 0.05, 0.5) * rate / std::pow(size.rms, 0.75);
        break;
      case Law::overflow:
      case Law::weir:
        one.a = size.low + random_.uniform(0.5, 0.85) * (peak - size.low);
        one.b = one.law == Law::weir ? 8 * rate / std::pow(0.1 * (peak - size.low), 1.5) * 0.1 : 0;
        if (one.law == Law::overflow && count > static_cast<std::size_t>(one.target) + 1 && random_.chance(0.5))
          one.other = one.target + 1, one.b = random_.uniform(0.4, 1);
        break;
      case Law::choke:
        one.a = graded(random_, 0.2, 0.8) * rate / std::sqrt(size.rms);
        one.b = size.low + random_.uniform(0.25, 0.6) * (peak - size.low), one.c = 0.03 * (peak - size.low);
        break;
      case Law::radiation:
        one.a = graded(random_, 0.1, 0.8) * rate, one.b = peak;
        break;
      case Law::exchange:
        one.other = one.target == 0 && count > 1 ? 1 : 0;
        one.a = graded(random_, 0.3, 1) * rate / size.spread, one.b = period;
        break;
      default:
        one.a = random_.sign() * graded(random_, 0.05, 0.5) * rate, one.b = period;
    }
  }

  void signal(Hidden& one, const Size& size) {
    const double time = machine_.time_scale;
    const double shortest = machine_.period;  // delays and lags of less than a row cannot be seen
    switch (one.law) {
      case Law::gain:
      case Law::asymmetry:
        one.a = random_.sign() * graded(random_, 0.05, 0.3);
        break;
      case Law::dead_zone:
      case Law::dead_step:
        one.a = graded(random_, 0.05, 0.4) * size.rms;
        break;
      case Law::clip:
      case Law::smooth_clip:
      case Law::tanh_clip:
        one.a = random_.uniform(0.4, 0.85) * size.peak;
        break;
      case Law::rate_limit:
        one.a = random_.log_uniform(0.6, 6) * size.rms / time;
        break;
      case Law::delay:
        one.a = shortest + random_.log_uniform(0.01, 0.15) * time;
        break;
      case Law::lag:
      case Law::second_lag:
        one.a = shortest + random_.log_uniform(0.01, 0.2) * time;
        break;
      case Law::sag:
        one.a = graded(random_, 0.08, 0.4) / size.peak;
        break;
      case Law::uneven_gain:
        one.a = graded(random_, 0.2, 0.7), one.b = size.peak * random_.uniform(0.4, 1);
        break;
      case Law::ageing:
        one.a = graded(random_, 0.3, 0.8), one.b = size.rms, one.c = sizes_.duration * random_.uniform(0.3, 1);
        break;
      default:  // a gain that swings
        one.a = graded(random_, 0.15, 0.6), one.b = time * random_.uniform(0.7, 4), one.c = random_.uniform(0, circle);
    }
  }

  void sensor(Hidden& one) {
    const auto k = static_cast<std::size_t>(one.target);
    const double spread = sizes_.outputs[k].spread;
    switch (one.law) {
      case Law::scale:
        one.a = random_.sign() * graded(random_, 0.04, 0.2);
        break;
      case Law::sensor_delay:
        one.a = machine_.period + random_.log_uniform(0.01, 0.15) * machine_.time_scale;
        break;
      case Law::drift:
      case Law::warm_drift:
        one.a = random_.sign() * 2 * graded(random_, 0.03, 0.2) * spread / sizes_.duration;
        one.b = 0.6 * sizes_.duration;
        break;
      case Law::round_off:
      case Law::floor_off:
        one.a = noise_[k] * graded(random_, 4, 15);
        break;
      case Law::sensor_backlash:
        one.a = graded(random_, 0.03, 0.25) * spread;
        break;
      default:
        one.a = random_.sign() * graded(random_, 0.03, 0.2) * spread;
    }
  }

  void parameter(Hidden& one) {
    const double size = random_.sign() * graded(random_, 0.1, 0.5);  // by the end
    one.b = 0.5 * sizes_.duration;
    one.a = one.law == Law::linear_drift ? size / sizes_.duration : one.law == Law::late_drift ? size / 4 : size;
  }

 private:
  void dry(Hidden& one, double force, double speed) {
    one.a = graded(random_, 0.08, 0.5) * force;
    one.b = one.law == Law::smooth_dry || one.law == Law::arctan_dry ? 0.03 * speed : random_.uniform(0.4, 1.2);
    one.c = random_.uniform(0.1, 0.4) * speed;
  }

  // Laws that look at a position; false if this one does not.
  bool positional(Hidden& one, double force, double speed, const Size& position) {
    const double middle = 0.5 * (position.low + position.high), half = 0.5 * (position.high - position.low);
    switch (one.law) {
      case Law::cubic:
      case Law::sinh_spring:
      case Law::tangent_spring:
        one.a = graded(random_, 0.1, 0.8) * force / std::pow(position.rms, 3), one.b = position.peak;
        return true;
      case Law::dahl:
      case Law::square_hysteresis:
        one.a = graded(random_, 0.15, 0.6) * force, one.b = random_.uniform(0.1, 0.4) * position.spread;
        return true;
      case Law::seen_backlash:
      case Law::load_behind_gap:
        one.a = graded(random_, 0.03, 0.15) * position.spread, one.b = random_.uniform(0.3, 1);
        return true;
      case Law::resonator:
      case Law::two_resonators:
        one.a = graded(random_, 0.15, 0.6), one.b = circle / machine_.time_scale * random_.uniform(1.5, 4);
        one.c = random_.uniform(0.03, 0.15), one.d = random_.uniform(1.5, 2);
        return true;
      case Law::hard_stop:
      case Law::elastic_stop:
        one.b = random_.sign(), one.a = middle + one.b * random_.uniform(0.45, 0.85) * half;
        one.c = random_.uniform(0, 0.4);
        return true;
      case Law::sine_cogging:
      case Law::triangle_cogging:
      case Law::two_wave_cogging:
        one.a = graded(random_, 0.1, 0.5) * force, one.b = half / random_.uniform(2, 6);
        one.c = random_.uniform(0, circle);
        return true;
      default:
        return local(one, force, speed, middle, half);
    }
  }

  // Laws of one stretch of positions.
  bool local(Hidden& one, double force, double speed, double middle, double half) {
    const double where = middle + random_.uniform(-0.5, 0.5) * half;
    switch (one.law) {
      case Law::detent:
        one.a = graded(random_, 0.5, 1.5) * force, one.b = where, one.c = random_.uniform(0.06, 0.15) * half;
        return true;
      case Law::sticky_patch:
        one.a = graded(random_, 0.8, 4) * force / speed, one.b = where, one.c = random_.uniform(0.1, 0.25) * half;
        return true;
      case Law::weak_zone:
        one.a = graded(random_, 0.4, 0.9), one.b = where, one.c = random_.uniform(0.1, 0.25) * half;
        return true;
      case Law::growing_inertia:
        one.a = graded(random_, 0.4, 1.5), one.b = random_.uniform(0.3, 0.6) * half, one.c = 0.04 * half;
        return true;
      default:
        return false;
    }
  }

  Random& random_;
  const Machine& machine_;
  const Sizes& sizes_;
  const std::vector<double>& noise_;
};

// Names of the place, and others that mean it: of what a speed moves, what reads it, constant multiples of a signal.
void name_place(Hidden& one, const Machine& machine, Where where) {
  const auto t = static_cast<std::size_t>(one.target);
  const auto readers = [&](int state) {
    for (const Output& output : machine.outputs)
      if (output.state == state) one.also.push_back(output.column);
  };
  int group = 0;
  if (where == Where::speed || where == Where::state) {
    one.attached_to = machine.states[t].name;
    if (where == Where::speed) readers(one.target);
    const int position = machine.states[t].position;
    if (position >= 0) one.also.push_back(machine.states[static_cast<std::size_t>(position)].name), readers(position);
  } else if (where == Where::input) {
    one.attached_to = machine.inputs[t].name, group = machine.inputs[t].group;
  } else if (where == Where::signal) {
    one.attached_to = machine.signals[t].name, group = machine.signals[t].group;
  } else if (where == Where::link) {
    one.attached_to = machine.signals[t].name;
    for (const Link& link : machine.links) {
      if (link.signal != one.attached_to) continue;
      for (const int speed : {link.first_speed, link.second_speed}) {
        const State& state = machine.states[static_cast<std::size_t>(speed)];
        one.also.push_back(state.name);
        one.also.push_back(machine.states[static_cast<std::size_t>(state.position)].name);
      }
    }
  } else if (where == Where::sensor) {
    one.attached_to = machine.outputs[t].column;
    one.also.push_back(machine.states[static_cast<std::size_t>(machine.outputs[t].state)].name);
  } else {
    one.attached_to = machine.parameters[t].name;
  }
  for (const Input& input : machine.inputs)
    if (group > 0 && input.group == group) one.also.push_back(input.name);
  for (const Signal& signal : machine.signals)
    if (group > 0 && signal.group == group) one.also.push_back(signal.name);
  std::erase(one.also, one.attached_to);
}

// As the library calls the parameter that is Hidden::a.
std::string name_of_strength(const std::string& name) {
  static const std::map<std::string, std::string> table{
      {"viscous_friction", "damping"},  {"load_dependent_friction", "factor"}, {"quadratic_drag", "drag"},
      {"constant_force", "force"},      {"cubic_stiffness", "stiffness"},      {"hysteresis", "force"},
      {"backlash", "half_width"},       {"joint_elasticity", "ratio"},         {"cogging", "amplitude"},
      {"gravity_offset", "weight"},     {"leak", "leak"},                      {"constant_rate", "rate"},
      {"input_gain", "excess"},         {"input_asymmetry", "asymmetry"},      {"dead_zone", "width"},
      {"rate_limit", "rate"},           {"input_delay", "delay"},              {"first_order_lag", "time"},
      {"supply_sag", "sag"},            {"sensor_bias", "bias"},               {"sensor_scale", "excess"},
      {"sensor_delay", "delay"},        {"sensor_drift", "rate"},              {"quantization", "step"},
      {"parameter_drift", "rate"}};
  const auto at = table.find(name);
  return at == table.end() ? "level" : at->second;
}

}  // namespace

bool is_open(const Grammar& grammar, const Candidate& candidate) {
  const Laws& known = laws().at(candidate.name);
  return grammar.examination || !known.same.empty() || !known.other.empty();
}

Hidden draw_hidden(Random& random, const Grammar& grammar, const Machine& machine, const Sizes& sizes,
                   const Candidate& candidate, const std::vector<double>& noise) {
  Hidden one;
  one.name = candidate.name;
  one.target = candidate.target;
  one.where = candidate.where == Where::link ? Where::signal : candidate.where;
  one.law = draw_law(random, grammar, candidate, one.same_formula);
  const auto t = static_cast<std::size_t>(one.target);
  Drawing drawing(random, machine, sizes, noise);
  if (candidate.where == Where::link) {
    one.a = graded(random, 0.05, 0.5) * sizes.signals[t].peak;
  } else if (one.where == Where::speed) {
    drawing.force(one);
  } else if (one.where == Where::state) {
    drawing.other_state(one, machine.states.size());
  } else if (one.where == Where::input) {
    drawing.signal(one, sizes.inputs[t]);
  } else if (one.where == Where::signal) {
    drawing.signal(one, sizes.signals[t]);
  } else if (one.where == Where::sensor) {
    drawing.sensor(one);
  } else {
    drawing.parameter(one);
  }
  name_place(one, machine, candidate.where);
  const auto outside = outside_names().find(candidate.name);
  if (outside != outside_names().end()) one.name = outside->second;
  one.numbers = {{name_of_strength(one.name), one.a, ""}};
  return one;
}

}  // namespace machines

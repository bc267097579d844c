#include "draw_effects.hpp"

#include <algorithm>
#include <cmath>

#include "circle.hpp"
#include "law_table.hpp"

namespace machines {
namespace {

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
        one.c = random_.uniform(0.1, 0.6) * speed * machine_.period;
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
      case Law::raised_hole:
        one.b = size.low + random_.uniform(0.1, 0.4) * (peak - size.low);
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
      case Law::third_lag:
      case Law::fourth_lag:
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
    const bool smooth = one.law == Law::smooth_dry || one.law == Law::arctan_dry || one.law == Law::rational_dry;
    one.b = smooth ? 0.03 * speed : random_.uniform(0.4, 1.2);
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

}  // namespace

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
  one.name = full_name(candidate.name);
  one.numbers = {{name_of_strength(one.name), one.a, ""}};
  return one;
}

}  // namespace machines

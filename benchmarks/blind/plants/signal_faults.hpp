// Formulas of faults of signals: of commands on their way in and of readings on their way out.
#pragma once

#include <algorithm>
#include <cmath>

#include "plant.hpp"

namespace plants {

inline double soft_clip(double value, double level) {
  const double ratio = std::abs(value) / level;
  return value / std::pow(1 + ratio * ratio * ratio * ratio, 0.25);
}

/// Faults of an order that look at its present value alone. For supply_sag, `effort` is how hard the drive works, 0..1.
inline double static_signal(const Fault& fault, double value, double effort) {
  switch (fault.formula) {
    case Formula::gain:
      return value * (1 + fault.a);
    case Formula::asymmetry:
      return value * (value > 0 ? 1 + fault.a : 1 - fault.a);
    case Formula::dead_soft:
      return std::copysign(std::max(std::abs(value) - fault.a, 0.0), value);
    case Formula::dead_step:
      return std::abs(value) > fault.a ? value : 0.0;
    case Formula::saturation:
      return std::clamp(value, -fault.a, fault.a);
    case Formula::saturation_soft:
      return soft_clip(value, fault.a);
    case Formula::supply_sag:
      return value * (1 - fault.a * effort);
    default:
      return value;
  }
}

/// An order over the fine steps, in place. `times`: starts of the steps [s].
inline void change_order(const Fault& fault, const Column& times, Column& order) {
  const Column asked = order;
  switch (fault.formula) {
    case Formula::delay: {
      std::size_t from = 0;
      for (std::size_t i = 0; i < order.size(); ++i) {
        while (from + 1 < order.size() && times[from + 1] <= times[i] - fault.a + 1e-9) ++from;
        order[i] = asked[from];
      }
      return;
    }
    case Formula::lag:
    case Formula::lag_second: {
      double first = asked[0], second = asked[0];
      const bool twice = fault.formula == Formula::lag_second;
      const double constant = twice ? fault.a / 2 : fault.a;
      for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = twice ? second : first;
        const double step = i + 1 < order.size() ? times[i + 1] - times[i] : 0;
        const double share = 1 - std::exp(-step / constant);
        first += (asked[i] - first) * share;
        second += (first - second) * share;
      }
      return;
    }
    case Formula::rate_limit: {
      double now = asked[0];
      for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = now;
        const double step = i + 1 < order.size() ? times[i + 1] - times[i] : 0;
        now += std::clamp(asked[i] - now, -fault.a * step, fault.a * step);
      }
      return;
    }
    default:
      for (double& value : order) value = static_signal(fault, value, std::abs(value));
  }
}

inline double factor_of_parameter(const Fault& fault, double time) {
  if (fault.formula == Formula::parameter_warm) return 1 + fault.a * (1 - std::exp(-time / fault.b));
  return 1 + fault.a * time;
}

/// What a sensor makes of the true values. `times` [s] or rows.
inline void change_readings(const Fault& fault, const Column& times, Column& values) {
  const Column actual = values;
  std::size_t from = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double now = times[i] - times[0];
    switch (fault.formula) {
      case Formula::bias:
        values[i] += fault.a;
        break;
      case Formula::scale:
        values[i] *= 1 + fault.a;
        break;
      case Formula::drift:
        values[i] += fault.a * now;
        break;
      case Formula::drift_warm:
        values[i] += fault.a * fault.b * (1 - std::exp(-now / fault.b));
        break;
      case Formula::quantization:
        values[i] = fault.a * std::round(values[i] / fault.a);
        break;
      case Formula::quantization_floor:
        values[i] = fault.a * std::floor(values[i] / fault.a);
        break;
      case Formula::sensor_delay: {
        const double then = std::max(times[i] - fault.a, times[0]);
        while (from + 1 < i && times[from + 1] <= then) ++from;
        if (i == 0) break;
        const double share = std::clamp((then - times[from]) / (times[from + 1] - times[from]), 0.0, 1.0);
        values[i] = actual[from] + share * (actual[from + 1] - actual[from]);
        break;
      }
      default:
        break;
    }
  }
}

}  // namespace plants

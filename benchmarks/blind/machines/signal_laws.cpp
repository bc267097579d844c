// Effects on other states, on inputs and signals, on parameters and in sensors.
#include <cmath>

#include "circle.hpp"
#include "laws.hpp"

namespace machines {
namespace {

// Means over the steps of what was asked a delay earlier, so that a change within a step has its exact effect.
void delay_input(double delay, const Column& times, Column& values) {
  Column integral{0};  // of what was asked, from the first step on
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    integral.push_back(integral[i] + values[i] * (times[i + 1] - times[i]));
  const Column asked = values;
  std::size_t from = 0;
  const auto until = [&](double time) {
    if (time <= times[0]) return asked[0] * (time - times[0]);
    while (from + 1 < times.size() && times[from + 1] <= time) ++from;
    return integral[from] + asked[from] * (time - times[from]);
  };
  double before = until(times[0] - delay);
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    const double now = until(times[i + 1] - delay);
    values[i] = (now - before) / (times[i + 1] - times[i]);
    before = now;
  }
  values.back() = asked[from];
}

// Rate limits and what wears: one pass from the first step to the last. A step gets the mean of what its ends
// have, so that nothing is later than the law says.
void remember(const Hidden& one, const Column& times, Column& values) {
  const Column asked = values;
  double first = asked[0], work = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double step = i + 1 < values.size() ? times[i + 1] - times[i] : 0;
    const double first_before = first, work_before = work;
    if (one.law == Law::rate_limit) {
      first += std::clamp(asked[i] - first, -one.a * step, one.a * step);
      values[i] = 0.5 * (first_before + first);
    } else if (one.law == Law::ageing) {
      work += (std::abs(asked[i]) / one.b - work) * step / one.c;
      values[i] = asked[i] * (1 - std::min(0.5 * one.a * (work_before + work), 0.95));
    } else if (one.law == Law::slow_sag) {
      work += (std::abs(asked[i]) - work) * (1 - std::exp(-step / one.b));
      values[i] = asked[i] * (1 - 0.5 * one.a * (work_before + work));
    }
  }
}

// Lags in a row, each of which gets the means that the one before has left.
void lag(const Hidden& one, const Column& times, Column& values) {
  const int lags = lags_of(one.law);
  for (int n = 0; n < lags; ++n) {
    double now = values[0];
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double step = i + 1 < values.size() ? times[i + 1] - times[i] : 0, before = now;
      now += (values[i] - now) * (1 - std::exp(-step * lags / one.a));
      values[i] = 0.5 * (before + now);
    }
  }
}

}  // namespace

void Past::add(double time, double value, double longest) {
  values_.emplace_back(time, value);
  while (values_.size() > 2 && values_[1].first < time - 1.5 * longest) values_.pop_front();
}

double Past::value_at(double time) const {
  if (time <= values_.front().first) return values_.front().second;
  for (std::size_t i = values_.size(); i-- > 1;) {
    const auto& [earlier, old] = values_[i - 1];
    const auto& [later, young] = values_[i];
    if (time >= earlier) return old + (young - old) * std::clamp((time - earlier) / (later - earlier), 0.0, 1.0);
  }
  return values_.front().second;
}

bool has_memory(Law law) { return lags_of(law) > 0 || law == Law::rate_limit || law == Law::delay; }

int lags_of(Law law) {
  switch (law) {
    case Law::lag:
      return 1;
    case Law::second_lag:
      return 2;
    case Law::third_lag:
      return 3;
    case Law::fourth_lag:
      return 4;
    default:
      return 0;
  }
}

double rate_of(const Hidden& one, const Surroundings& around) {
  const double x = around.amount;
  switch (one.law) {
    case Law::leak:
      return -one.a * x;
    case Law::hole:
      return -one.a * std::sqrt(std::max(x, 0.0));
    case Law::raised_hole:
      return -one.a * std::sqrt(std::max(x - one.b, 0.0));
    case Law::power_leak:
      return -one.a * std::pow(std::max(x, 0.0), 0.75);
    case Law::rate:
      return one.a;
    case Law::weir:
      return -one.b * std::pow(std::max(x - one.a, 0.0), 1.5);
    case Law::ripple:
      return one.a * std::sin(circle * around.time / one.b + one.c);
    case Law::choke:
      return one.a * std::sqrt(std::max(x, 0.0)) / (1 + std::exp((x - one.b) / one.c));
    case Law::exchange:
      return one.a * (around.other - x) * std::sin(circle * around.time / one.b + one.c);
    case Law::radiation:
      return -one.a * std::pow(std::max(x, 0.0) / one.b, 4);
    default:
      return 0;
  }
}

double static_signal(const Hidden& one, double value, double time) {
  const double size = std::abs(value);
  switch (one.law) {
    case Law::gain:
      return value * (1 + one.a);
    case Law::asymmetry:
      return value * (value > 0 ? 1 + one.a : 1 - one.a);
    case Law::dead_zone:
      return std::copysign(std::max(size - one.a, 0.0), value);
    case Law::dead_step:
      return value / (1 + std::exp(-(size - one.a) / (0.05 * one.a)));
    case Law::clip:
      return std::clamp(value, -one.a, one.a);
    case Law::smooth_clip:
      return value / std::pow(1 + std::pow(size / one.a, 4), 0.25);
    case Law::tanh_clip:
      return one.a * std::tanh(value / one.a);
    case Law::sag:
      return value * std::max(1 - one.a * size, 0.0);
    case Law::uneven_gain:
      return value * (1 + one.a * std::sin(circle * value / one.b));
    case Law::gusts:
      return value * (1 + one.a * std::sin(circle * time / one.b + one.c));
    default:
      return value;
  }
}

void change_input(const Hidden& one, const Column& times, Column& values) {
  if (values.empty()) return;
  if (one.law == Law::delay) return delay_input(one.a, times, values);
  if (lags_of(one.law) > 0) return lag(one, times, values);
  if (has_memory(one.law) || one.law == Law::ageing || one.law == Law::slow_sag) return remember(one, times, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double end = i + 1 < values.size() ? times[i + 1] : times[i];
    values[i] = static_signal(one, values[i], 0.5 * (times[i] + end) - times[0]);
  }
}

double factor_of_parameter(const Hidden& one, double time) {
  if (one.law == Law::warm_up) return 1 + one.a * (1 - std::exp(-time / one.b));
  if (one.law == Law::late_drift) return 1 + one.a * std::pow(time / one.b, 2);
  if (one.law == Law::midway_drift) return 1 + one.a / (1 + std::exp((one.b - time) / (0.2 * one.b)));
  if (one.law == Law::passing_drift) return 1 + one.a * std::exp(-std::pow((time - one.b) / (0.4 * one.b), 2));
  return std::max(1 + one.a * time, 0.05);
}

bool rounds(Law law) { return law == Law::round_off || law == Law::floor_off; }

Hidden unrounded(Hidden one) {
  if (!rounds(one.law)) return one;
  one.a = one.law == Law::floor_off ? -one.a / 2 : 0;
  one.law = Law::bias;
  return one;
}

void change_readings(const Hidden& one, const Column& times, Column& values) {
  double held = values.empty() ? 0 : values[0];
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double now = times[i] - times[0];
    switch (one.law) {
      case Law::bias:
        values[i] += one.a;
        break;
      case Law::scale:
        values[i] *= 1 + one.a;
        break;
      case Law::drift:
        values[i] += one.a * now;
        break;
      case Law::warm_drift:
        values[i] += one.a * one.b * (1 - std::exp(-now / one.b));
        break;
      case Law::round_off:
        values[i] = one.a * std::round(values[i] / one.a);
        break;
      case Law::floor_off:
        values[i] = one.a * std::floor(values[i] / one.a);
        break;
      case Law::sensor_backlash:
        held = values[i] = within(held, values[i], one.a);
        break;
      default:
        break;
    }
  }
}

}  // namespace machines

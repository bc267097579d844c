// A sensor that reads late: y(t - delay), interpolated between rows. Before the first row its value there counts or,
// form "in motion", the straight line through the first two rows. Delay in seconds, for maps in steps. Cost: linear in
// the rows. Confusable with a late input (the near twin unless the sensor is fed back) and with a lag.
#pragma once

#include <cstddef>
#include <vector>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// What came before the first row: what is read in it, or the line that begins there.
enum class Before : unsigned char { still, line };

inline void read_late(const Series& series, double delay, Before before) {
  const std::size_t rows = series.readings.size();
  if (rows == 0) return;
  const std::vector<double> now(series.readings.begin(), series.readings.end());
  std::size_t after = 0;  // the first row later than the context that is read
  for (std::size_t row = 0; row < rows; ++row) {
    const double t = series.time[row] - delay;
    while (after < rows && series.time[after] <= t) ++after;
    if (after == 0) {
      const bool moving = before == Before::line && rows > 1;
      const double slope = moving ? (now[1] - now[0]) / (series.time[1] - series.time[0]) : 0;
      series.readings[row] = now[0] + slope * (t - series.time[0]);
    } else if (after == rows) {
      series.readings[row] = now[rows - 1];
    } else {
      const double share = (t - series.time[after - 1]) / (series.time[after] - series.time[after - 1]);
      series.readings[row] = now[after - 1] + share * (now[after] - now[after - 1]);
    }
  }
}

[[gnu::cold]] inline Effect sensor_delay() {
  return {.name = "sensor_delay",
          .sentence = "the sensor {at} reads {delay} late",
          .place = Place::output,
          .parameters = parameters_of({{.name = "delay",
                                        .measure = {.time = 1},
                                        .low = 0,
                                        .high = 0.5,
                                        .starts = {0.002, 0.01, 0.05},
                                        .strength = true}}),
          .confusable_with = names_of({"input_delay", "first_order_lag", "backlash"}),
          .experiment = "move it by hand, or by a known drive, past a mark seen by a second sensor",
          .delay = +[](Values p) { return p[0]; },
          .sensor = +[](const Series& series, Values p) { read_late(series, p[0], Before::still); }};
}

[[gnu::cold]] inline Effect sensor_delay_in_motion() {
  Effect effect = sensor_delay();
  effect.form = "in motion";
  effect.extends = {""};
  effect.sensor = +[](const Series& series, Values p) { read_late(series, p[0], Before::line); };
  return effect;
}

}  // namespace surefoot::effects

// A sensor that reads late: y(t - delay), interpolated between rows; before the first row its value there counts. Delay
// in seconds, for maps in steps. Form "long": seconds instead of hundredths. Cost: linear in the rows.
// Confusable with a late input (the near twin unless the sensor is fed back) and with a lag.
#pragma once

#include <cstddef>
#include <vector>

#include "surefoot/diagnose/effect.hpp"

namespace surefoot::effects {

namespace detail {

inline void read_late(const Series& series, double delay) {
  const std::size_t rows = series.readings.size();
  if (rows == 0) return;
  const std::vector<double> now(series.readings.begin(), series.readings.end());
  std::size_t after = 0;  // the first row later than the moment that is read
  for (std::size_t row = 0; row < rows; ++row) {
    const double t = series.time[row] - delay;
    while (after < rows && series.time[after] <= t) ++after;
    if (after == 0) {
      series.readings[row] = now[0];
    } else if (after == rows) {
      series.readings[row] = now[rows - 1];
    } else {
      const double share = (t - series.time[after - 1]) / (series.time[after] - series.time[after - 1]);
      series.readings[row] = now[after - 1] + share * (now[after] - now[after - 1]);
    }
  }
}

inline Effect sensor_delay_of(std::string form, double high, std::vector<double> starts) {
  return {.name = "sensor_delay",
          .sentence = "the sensor {at} reads {delay} late",
          .place = Place::output,
          .parameters = {{.name = "delay",
                          .measure = {.time = 1},
                          .low = 0,
                          .high = high,
                          .starts = std::move(starts),
                          .strength = true}},
          .confusable_with = {"input_delay", "first_order_lag", "backlash"},
          .experiment = "move it by hand, or by a known drive, past a mark seen by a second sensor",
          .form = std::move(form),
          .sensor = [](const Series& series, Values p) { read_late(series, p[0]); }};
}

}  // namespace detail

inline Effect sensor_delay() { return detail::sensor_delay_of("", 0.3, {0.002, 0.01, 0.05}); }

inline Effect sensor_delay_long() { return detail::sensor_delay_of("long", 10, {1, 3}); }

}  // namespace surefoot::effects

// Common parts of the families: parameters, model files, sizes of the motion.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "draw_forces.hpp"
#include "plant.hpp"
#include "text.hpp"

namespace plants {

/// A positive parameter whose nominal value is up to 20 % wrong, or known when fixed.
inline Parameter guessed(Random& random, const std::string& name, const std::string& unit, double actual,
                         bool fixed = false) {
  const double wrong = fixed ? 1.0 : random.uniform(0.8, 1.2);
  const double nominal = std::stod(text(actual * wrong, "%.4g"));
  return {name, unit, fixed ? nominal : actual, nominal, 0.2 * nominal, 5 * nominal, fixed};
}

inline std::string parameters_toml(const System& system) {
  std::string toml = "\n[parameters]\n";
  for (const Parameter& p : system.parameters) {
    toml += p.name + " = { value = " + text(p.nominal) + ", min = " + text(p.low) + ", max = " + text(p.high);
    toml += ", unit = \"" + p.unit + "\"" + (p.fixed ? ", fixed = true" : "") + " }\n";
  }
  return toml;
}

inline std::string noise_entry(bool shown, double noise) { return shown ? ", noise = " + text(noise, "%.3g") : ""; }

inline double root_mean_square(const Column& values) {
  double sum = 0;
  for (double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

inline double spread(const Column& values) {
  double mean = 0;
  for (double value : values) mean += value / static_cast<double>(values.size());
  Column centred;
  for (double value : values) centred.push_back(value - mean);
  return root_mean_square(centred);
}

/// Sizes of the motion of a one-degree-of-freedom machine without faults.
inline void measure_motion(const System& system, Typical& typical) {
  Column speeds, positions, efforts, orders;
  for (const Recording& recording : system.recordings) {
    const Series series = system.simulate(actual_values(system), {}, recording, {});
    const Column &q = series.states[0], &v = series.states[1];
    for (std::size_t i = 1; i < q.size(); ++i) {
      efforts.push_back((v[i] - v[i - 1]) / (recording.time[i] - recording.time[i - 1]));
      speeds.push_back(v[i]);
      positions.push_back(q[i]);
      orders.push_back(recording.inputs[0][i]);
    }
  }
  typical.effort = root_mean_square(efforts);
  typical.speed = root_mean_square(speeds);
  typical.position = spread(positions);
  typical.order = root_mean_square(orders);
  for (double q : positions) typical.reach = std::max(typical.reach, std::abs(q));
}

}  // namespace plants

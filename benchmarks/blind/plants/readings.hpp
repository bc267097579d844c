// Readings made of ideal outputs: coloured noise, rounding, missing cells, rarely an outlier.
#pragma once

#include <cmath>
#include <limits>

#include "plant.hpp"

namespace plants {

/// How a case is measured.
struct Sensing {
  double correlation = 0;  // of the noise from row to row (first-order autoregression)
  double resolution = 0;   // rounding of the readings, in standard deviations of the noise
  double missing = 0;      // share of empty cells
  bool outlier = false;    // one reading is a gross error
};

inline Sensing draw_sensing(Random& random, bool final_only) {
  Sensing sensing;
  sensing.resolution = random.chance(0.5) ? 0.1 : random.uniform(0.3, 1.0);
  if (final_only) return sensing;
  sensing.correlation = random.uniform(0, 0.6);
  if (random.chance(0.3)) sensing.missing = random.uniform(0.001, 0.01);
  sensing.outlier = random.chance(0.1);
  return sensing;
}

inline Column coloured(Random& random, std::size_t rows, double deviation, double correlation) {
  Column noise;
  double now = random.normal(deviation);
  for (std::size_t i = 0; i < rows; ++i) {
    noise.push_back(now);
    now = correlation * now + random.normal(deviation * std::sqrt(1 - correlation * correlation));
  }
  return noise;
}

/// Fills recording.readings from recording.ideal.
inline void read_out(Random& random, const System& system, const Sensing& sensing, Recording& recording) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  recording.readings = recording.ideal;
  recording.outliers.clear();
  for (std::size_t k = 0; k < recording.ideal.size(); ++k) {
    Column& column = recording.readings[k];
    const double step = sensing.resolution * system.noise[k];
    const Column noise = coloured(random, column.size(), system.noise[k], sensing.correlation);
    for (std::size_t i = 0; i < column.size(); ++i) {
      column[i] = step * std::round((column[i] + noise[i]) / step);
      const bool unseen = system.final_only ? i + 1 < column.size() : i > 0 && random.chance(sensing.missing);
      if (unseen) column[i] = nothing;
    }
    recording.outliers.emplace_back(column.size(), false);
  }
}

inline void add_outlier(Random& random, const System& system, Recording& recording) {
  const std::size_t k = random.index(system.outputs.size()), row = 10 + random.index(recording.readings[k].size() - 20);
  if (!std::isfinite(recording.readings[k][row])) return;
  recording.readings[k][row] += random.sign() * random.uniform(20, 60) * system.noise[k];
  recording.outliers[k][row] = true;
}

}  // namespace plants

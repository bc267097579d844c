#include "start_guess.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace diagnose_program {
namespace {

struct Sample {
  double time, value;
};

// In the unit of the state that is read.
std::vector<Sample> measured(const surefoot::Recording& recording, const ReadState& read) {
  std::vector<Sample> samples;
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    const double value = recording.outputs(read.output, row);
    if (!std::isnan(value)) samples.push_back({recording.time[row], (value - read.offset) / read.slope});
  }
  return samples;
}

double spread(const std::vector<Sample>& samples) {
  double mean = 0, squares = 0;
  for (const Sample& sample : samples) mean += sample.value / static_cast<double>(samples.size());
  for (const Sample& sample : samples) squares += (sample.value - mean) * (sample.value - mean);
  return std::sqrt(squares / static_cast<double>(samples.size()));
}

double positive(double scale, double otherwise) { return scale > 0 && std::isfinite(scale) ? scale : otherwise; }

// Slope of the line through the first few samples [1/s].
double first_slope(const std::vector<Sample>& samples) {
  const std::size_t count = std::min<std::size_t>(samples.size(), 5);
  double t = 0, y = 0, ty = 0, tt = 0;
  for (std::size_t i = 0; i < count; ++i) {
    t += samples[i].time / static_cast<double>(count);
    y += samples[i].value / static_cast<double>(count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    ty += (samples[i].time - t) * (samples[i].value - y);
    tt += (samples[i].time - t) * (samples[i].time - t);
  }
  return tt > 0 ? ty / tt : 0;
}

// Spread of the rate of change over the recording.
double rate_spread(const std::vector<Sample>& samples) {
  std::vector<Sample> rates;
  const std::size_t gap = std::max<std::size_t>(1, std::min<std::size_t>(4, samples.size() / 4));
  for (std::size_t i = gap; i < samples.size(); ++i) {
    const double length = samples[i].time - samples[i - gap].time;
    rates.push_back({samples[i].time, (samples[i].value - samples[i - gap].value) / length});
  }
  return rates.empty() ? 0 : spread(rates);
}

}  // namespace

StartGuess guess_start(const surefoot::Recording& recording, const StateStart& start) {
  constexpr double well_known = 0.1;  // share of the spread by which a measured value may be off
  if (start.measured.output >= 0) {
    const auto samples = measured(recording, start.measured);
    const double value = samples.front().value;
    return {value, positive(well_known * spread(samples), positive(well_known * std::abs(value), 1))};
  }
  if (start.speed_of.output >= 0) {
    const auto samples = measured(recording, start.speed_of);
    return {first_slope(samples), positive(0.5 * rate_spread(samples), 1)};
  }
  if (start.alike.output >= 0) {
    const auto samples = measured(recording, start.alike);
    const double value = samples.front().value;
    return {value, positive(spread(samples), positive(std::abs(value), 1))};
  }
  return {};
}

}  // namespace diagnose_program

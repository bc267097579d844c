#include "samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparse {
namespace {

using plants::Column;
using plants::Recording;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t half_window = 10;  // rows

// Value, first and second derivative in the middle of a parabola through the readings around a row.
Triple parabola(const Column& times, const Column& readings, std::size_t row) {
  double moments[5] = {}, right[3] = {};
  const double scale = times[row + half_window] - times[row];
  for (std::size_t i = row - half_window; i <= row + half_window; ++i) {
    if (!std::isfinite(readings[i])) continue;
    const double t = (times[i] - times[row]) / scale;
    double power = 1;
    for (int k = 0; k < 5; ++k, power *= t) {
      moments[k] += power;
      if (k < 3) right[k] += power * readings[i];
    }
  }
  // Cramer's rule on the normal equations.
  const auto determinant = [](const double(&m)[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  double matrix[3][3];
  Triple solution{};
  for (int column = -1; column < 3; ++column) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) matrix[i][j] = j == column ? right[i] : moments[i + j];
    if (column < 0) {
      solution.fill(1 / determinant(matrix));
    } else {
      solution[static_cast<std::size_t>(column)] *= determinant(matrix);
    }
  }
  return {solution[0], solution[1] / scale, 2 * solution[2] / (scale * scale)};
}

std::vector<Sample> steps(const Machine& machine, const Recording& recording) {
  std::vector<Sample> samples;
  const std::vector<Column>& pose = recording.readings;
  for (std::size_t row = 0; row + 1 < pose[0].size(); ++row) {
    const double dx = pose[0][row + 1] - pose[0][row], dy = pose[1][row + 1] - pose[1][row];
    const double heading = pose[2][row], turn = pose[2][row + 1] - heading;
    if (!std::isfinite(dx + dy + turn)) continue;
    Sample sample{&recording, look_at(machine, recording, row), {}};
    sample.at.state = {pose[0][row], pose[1][row], heading};
    const double c = std::cos(heading), s = std::sin(heading);
    sample.measured = {c * dx + s * dy, -s * dx + c * dy, turn};
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace

std::vector<Sample> collect(const Machine& machine, const Recording& recording, const plants::Values& parameters) {
  if (machine.motion == Motion::walk) return steps(machine, recording);
  std::vector<Sample> samples;
  const std::vector<Column>& readings = recording.readings;
  const std::size_t rows = readings[0].size();
  const bool upper_known = machine.output_state[0] == 0;
  Machine with_upper = machine;
  with_upper.output_state = {0};
  Column upper;
  if (!upper_known) {
    Recording start = recording;
    start.readings = {{recording.initial[0]}};
    upper = simulate(with_upper, parameters, {}, start)[0];
  }
  for (std::size_t row = half_window; row + half_window < rows; ++row) {
    Sample sample{&recording, look_at(machine, recording, row), {unknown, unknown, unknown}};
    const Triple first = parabola(recording.time, readings[0], row);
    if (machine.motion == Motion::one_dof) {
      sample.at.state = {first[0], first[1], 0};
      sample.measured[0] = first[2];
    } else if (upper_known) {
      const Triple second = parabola(recording.time, readings[1], row);
      sample.at.state = {first[0], second[0], 0};
      sample.measured = {first[1], second[1], unknown};
    } else {
      sample.at.state = {upper[row], first[0], 0};
      sample.measured = {unknown, first[1], unknown};
    }
    samples.push_back(sample);
  }
  return samples;
}

Sizes sizes_of(const std::vector<Sample>& samples) {
  Sizes sizes;
  for (const Sample& sample : samples)
    for (std::size_t k = 0; k < 3; ++k) {
      const double count = static_cast<double>(samples.size());
      sizes.state[k] += sample.at.state[k] * sample.at.state[k] / count;
      sizes.input[k] += sample.at.input[k] * sample.at.input[k] / count;
      sizes.reach[k] = std::max(sizes.reach[k], std::abs(sample.at.state[k]));
    }
  for (std::size_t k = 0; k < 3; ++k) {
    sizes.state[k] = std::max(std::sqrt(sizes.state[k]), 1e-9);
    sizes.input[k] = std::max(std::sqrt(sizes.input[k]), 1e-9);
    sizes.reach[k] = std::max(sizes.reach[k], 1e-9);
  }
  return sizes;
}

}  // namespace sparse

// Definitions of surefoot/diagnose/log_doctor/jumps.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/sensor_noise.hpp"
#include "surefoot/diagnose/log_doctor/jumps.hpp"
#include "surefoot/diagnose/log_doctor/reading_faults.hpp"

namespace surefoot::diagnosis {

/// Change of a reading into a row beyond that of the model; not a number where one is not read.
SUREFOOT_ONCE double change_beyond_model(const LogFit& fit, std::size_t r, Eigen::Index output, Eigen::Index row) {
  const Eigen::MatrixXd &read = fit.bound.recordings[r].outputs, &simulated = fit.runs[r].outputs;
  return read(output, row) - read(output, row - 1) - simulated(output, row) + simulated(output, row - 1);
}

/// What is usual of an output from row to row, as a standard deviation: at least noise and steps of its sensor.
SUREFOOT_ONCE double usual_change(const LogFit& fit, Eigen::Index output) {
  constexpr double of_median = 0.6745;  // the median absolute value of a normal distribution
  std::vector<double> changes;
  for (std::size_t r = 0; r < fit.runs.size(); ++r) {
    for (Eigen::Index row = 1; fit.runs[r].finite && row < fit.bound.recordings[r].rows(); ++row) {
      const double change = change_beyond_model(fit, r, output, row);
      if (std::isfinite(change)) changes.push_back(std::abs(change));
    }
  }
  const double noise = noise_of(fit.bound, all_recordings(fit.bound), output);
  const double sensor = std::max(noise, resolution_of(fit.bound.recordings, output));
  return std::max(median_of(changes) / of_median, sensor);
}

/// Whether a row ends a stretch of equal readings: a sensor that was stuck jumps as well.
SUREFOOT_ONCE bool ends_a_stretch(const Recording& recording, Eigen::Index output, Eigen::Index row,
                                  const LogDoctorCriteria& criteria) {
  const auto equal = static_cast<Eigen::Index>(criteria.constant_rows);
  if (row < equal) return false;
  for (Eigen::Index before = row - equal; before < row; ++before) {
    if (recording.outputs(output, before) != recording.outputs(output, row - 1)) return false;
  }
  return true;
}

/// How far all outputs jump into a row: that which does so least, in units of what is usual; 0 where one is not read,
/// or was stuck before.
SUREFOOT_ONCE double common_jump(const LogFit& fit, std::size_t r, Eigen::Index row, const std::vector<double>& usual,
                                 const LogDoctorCriteria& criteria) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < usual.size(); ++k) {
    if (ends_a_stretch(fit.bound.recordings[r], static_cast<Eigen::Index>(k), row, criteria)) return 0;
    const double change = std::abs(change_beyond_model(fit, r, static_cast<Eigen::Index>(k), row));
    if (!(std::isfinite(change) && usual[k] > 0)) return 0;
    least = std::min(least, change / usual[k]);
  }
  return least;
}

/// The largest change of an output beyond that of the model in any other row, of all recordings.
SUREFOOT_ONCE double largest_elsewhere(const LogFit& fit, std::size_t r, Eigen::Index output, Eigen::Index row) {
  double largest = 0;
  for (std::size_t o = 0; o < fit.runs.size(); ++o) {
    for (Eigen::Index other = 1; fit.runs[o].finite && other < fit.bound.recordings[o].rows(); ++other) {
      const double change = std::abs(change_beyond_model(fit, o, output, other));
      if ((o != r || other != row) && std::isfinite(change)) largest = std::max(largest, change);
    }
  }
  return largest;
}

/// Whether no output changes as much in any other row, and one by far less.
SUREFOOT_ONCE bool stands_out(const LogFit& fit, std::size_t r, Eigen::Index row, const LogDoctorCriteria& criteria) {
  bool by_far = false;
  for (Eigen::Index k = 0; k < fit.bound.recordings[r].outputs.rows(); ++k) {
    const double change = std::abs(change_beyond_model(fit, r, k, row)), elsewhere = largest_elsewhere(fit, r, k, row);
    if (!(change > elsewhere)) return false;
    by_far = by_far || change > criteria.decisive * elsewhere;
  }
  return by_far;
}

SUREFOOT_ONCE void add_jumps(const LogFit& fit, const LogDoctorCriteria& criteria, std::vector<FoundFault>& found) {
  constexpr double certain = 8;  // times what is usual: no noise
  const std::size_t count = fit.bound.recordings.size();
  if (fit.bound.info.kind != SimulatorKind::ode || fit.bound.integration.restart > 0 || count < 2) return;
  std::vector<double> usual;
  for (std::size_t k = 0; k < fit.bound.info.outputs.size(); ++k) {
    usual.push_back(usual_change(fit, static_cast<Eigen::Index>(k)));
  }
  for (std::size_t r = 0; r < count; ++r) {
    if (!fit.runs[r].finite) continue;
    Eigen::Index row = 0;
    double jump = certain;
    for (Eigen::Index other = 1; other < fit.bound.recordings[r].rows(); ++other) {
      const double size = common_jump(fit, r, other, usual, criteria);
      if (!(size > jump)) continue;
      jump = size;
      row = other;
    }
    if (row == 0 || !stands_out(fit, r, row, criteria)) continue;
    LogRepair lost{.kind = LogFaultKind::jump};
    lost.rows.emplace_back(row - 1, row);
    found.push_back({{lost}, r});
  }
}

}  // namespace surefoot::diagnosis

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

/// What is usual of each output from row to row, as a standard deviation: at least noise and steps of its sensor.
SUREFOOT_ONCE Eigen::VectorXd usual_changes(const LogFit& fit) {
  constexpr double of_median = 0.6745;  // the median absolute value of a normal distribution
  Eigen::VectorXd usual(static_cast<Eigen::Index>(fit.bound.info.outputs.size()));
  for (Eigen::Index k = 0; k < usual.size(); ++k) {
    std::vector<double> changes;
    for (std::size_t r = 0; r < fit.runs.size(); ++r) {
      for (Eigen::Index row = 1; fit.runs[r].finite && row < fit.bound.recordings[r].rows(); ++row) {
        const double change = change_beyond_model(fit, r, k, row);
        if (std::isfinite(change)) changes.push_back(std::abs(change));
      }
    }
    usual[k] = std::max({median_of(changes) / of_median, noise_of(fit.bound, all_recordings(fit.bound), k),
                         resolution_of(fit.bound.recordings, k)});
  }
  return usual;
}

SUREFOOT_ONCE Eigen::VectorXd common_jumps(const LogFit& fit, std::size_t r, const Eigen::VectorXd& usual) {
  Eigen::VectorXd jumps = Eigen::VectorXd::Zero(fit.bound.recordings[r].rows());
  for (Eigen::Index row = 1; row < jumps.size(); ++row) {
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < usual.size(); ++k) {
      const double change = std::abs(change_beyond_model(fit, r, k, row));
      least = std::isfinite(change) && usual[k] > 0 ? std::min(least, change / usual[k]) : 0;
    }
    if (std::isfinite(least)) jumps[row] = least;
  }
  return jumps;
}

SUREFOOT_ONCE std::vector<FoundFault> find_jumps(const LogFit& fit, const LogDoctorCriteria& criteria) {
  constexpr double certain = 8;  // times what is usual: no noise
  const std::size_t count = fit.bound.recordings.size();
  if (fit.bound.info.kind != SimulatorKind::ode || fit.bound.integration.restart > 0 || count < 2) return {};
  const Eigen::VectorXd usual = usual_changes(fit);
  std::vector<double> largest(count), second(count);
  std::vector<Eigen::Index> where(count);
  for (std::size_t r = 0; r < count; ++r) {
    if (!fit.runs[r].finite) continue;
    const Eigen::VectorXd jumps = common_jumps(fit, r, usual);
    for (Eigen::Index row = 1; row < jumps.size(); ++row) {
      if (jumps[row] > largest[r]) {
        second[r] = largest[r];
        largest[r] = jumps[row];
        where[r] = row;
      } else {
        second[r] = std::max(second[r], jumps[row]);
      }
    }
  }
  std::vector<FoundFault> found;
  for (std::size_t r = 0; r < count; ++r) {
    const double elsewhere = std::max(second[r], worst_of_others(largest, r));
    if (!(largest[r] > std::max(certain, criteria.decisive * elsewhere))) continue;
    found.push_back({{{.kind = LogFaultKind::jump, .rows = {{where[r] - 1, where[r]}}}}, r});
  }
  return found;
}

}  // namespace surefoot::diagnosis

// Light calibration of the model to a log, robust to single recordings that are spoilt, and what it leaves of each.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/log_doctor/criteria.hpp"

namespace surefoot::diagnosis {

/// What the log doctor needs of its caller.
struct LogDoctorInputs {
  std::function<BoundSimulator(std::vector<Recording>)> bind;
  std::function<Hypothesis(const BoundSimulator&)> nominal;
  const Parallel& parallel;
  LogDoctorCriteria criteria = {};
  std::function<bool()> stopped = [] { return false; };  // the time is over: what was found until then counts
  std::vector<LogFault> named = {};                      // before: asked for again, however well the model fits
  bool may_leave_out = true;                             // a recording unlike all others
};

/// Simulated minus measured, output x row; NaN: not measured, infinite: the simulation ran away.
using ResidualRows = Eigen::MatrixXd;

struct LogFit {
  BoundSimulator bound;
  Hypothesis hypothesis;  // calibrated
  NoiseKind noise = NoiseKind::measurement;
  std::vector<SimulatedRun> runs;       // by recording
  std::vector<ResidualRows> residuals;  // by recording
  Eigen::VectorXd size;                 // by output: how much it moves, in the median recording
  Eigen::VectorXd typical;              // by output: root mean square residual of the median recording
  std::vector<double> error;            // by recording: mean square residual in units of `size`
};

/// Mean of the squared residuals, each output in its unit; infinite if any is.
double mean_square(const ResidualRows& residuals, const Eigen::VectorXd& unit);

/// Whether a mean square error says that a simulation left what was measured so far behind that it tells nothing of the
/// recording.
bool ran_away(double error, const LogDoctorCriteria& criteria);

/// Share of the residuals that count as independent of each other for their mean square: less where they are correlated
/// from row to row ((1 - r^2) / (1 + r^2) for a first-order autoregression).
double independent_share(const ResidualRows& residuals, const Eigen::VectorXd& unit);

double median_of(std::vector<double> values);

/// The largest error of all recordings but one.
double worst_of_others(const std::vector<double>& errors, std::size_t r);

/// By output, how much it moves: the standard deviation of the median recording, or of single steps where each starts
/// anew.
Eigen::VectorXd output_sizes(const BoundSimulator& bound);

/// A simulation of recording r in another version, which starts from that version's initial state.
struct Resimulation {
  SimulatedRun run;
  ResidualRows residuals;
};
Resimulation resimulate(const LogFit& fit, std::size_t r, const Recording& version);

/// `typical` and `error` of these residuals.
void summarize_residuals(LogFit& fit);

/// Calibrates from some parameters on (empty: the nominal ones, with a search if `points` > 0).
LogFit fit_log(const LogDoctorInputs& inputs, std::vector<Recording> recordings, const Eigen::VectorXd& parameters = {},
               std::size_t points = 0);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/log_fit.ipp"
#endif

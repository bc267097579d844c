// Faults of columns: signs, units and columns in each other's place, of one recording or of all. Each is a hypothesis
// that the recordings without it are simulated better.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "surefoot/diagnose/log_doctor/log_fit.hpp"
#include "surefoot/diagnose/log_doctor/log_repair.hpp"

namespace surefoot::diagnosis {

/// Repairs that are made together.
using Repairs = std::vector<LogRepair>;

/// A fault that was found, by its repair.
struct FoundFault {
  Repairs repairs;
  std::optional<std::size_t> recording = {};  // none: all
  std::vector<Repairs> also = {};             // what would cure it about as well
};

Recording repaired(const BoundSimulator& bound, Recording recording, const Repairs& repairs);

/// [s]
double median_interval(const Recording& recording);

/// What one recording's repair changes.
struct RepairEffect {
  double log_odds = 0;   // of the recording with the repair against without it
  double log_ratio = 0;  // logarithm of the mean square error before over after, each in the unit of the readings
  double after = 0;      // mean square error
  double over_unlike = 0;  // log odds of the recording with the repair against one that the model tells nothing of
};

/// How residuals of recordings differ in size, in units of what is typically left: a multivariate t distribution.
struct SpreadOfSizes {
  double degrees = 0;  // of freedom: the fewer, the more often a recording is far off that has no fault
  double scale = 1;
};

/// The most likely one of the recordings other than r.
SpreadOfSizes spread_of_others(const LogFit& fit, std::size_t r);

/// Log-likelihood of n independent readings of a recording that has nothing in common with the model, in units of what
/// is typically left: outputs as large as in the median recording, whatever was commanded.
double log_likelihood_if_unlike(const LogFit& fit, const ResidualRows& residuals, double n);

/// Compares residuals as logged with those after repairs.
RepairEffect effect_of(const LogFit& fit, std::size_t r, const Repairs& repairs, const ResidualRows& after,
                       const SpreadOfSizes& spread);

/// Whether the outputs whose sign is changed move by more than the model is typically off: else what they do is no sign
/// of a fault.
bool moves_beyond_misfit(const LogFit& fit, std::size_t r, const Repairs& repairs);

/// Whether the model misses what some repairs would change in a recording by as much as in the median one, or more:
/// what is small, as the sideways motion of a straight drive, is mended by anything.
bool is_odd(const LogFit& fit, std::size_t r, const Repairs& repairs);

/// All that may be undone in columns: each repair alone, and all angles at once.
std::vector<Repairs> repairs_to_try(const SimulatorInfo& info);

/// The most likely fault of a single recording, which others do not have; of that one alone, if it is said.
std::optional<FoundFault> find_fault_of_one(const LogDoctorInputs& inputs, const LogFit& fit,
                                            std::optional<std::size_t> only = {});

/// Share of its variance that is left of the output that fits worst, in the median recording.
double worst_output_error(const LogFit& fit);

/// The most likely fault that all recordings have.
std::optional<FoundFault> find_fault_of_all(const LogDoctorInputs& inputs, const LogFit& fit);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/column_faults.ipp"
#endif

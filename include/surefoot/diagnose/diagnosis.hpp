// Results of a diagnosis: plain data, the source of the report, of the JSON and of the augmented model.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/recording.hpp"
#include "surefoot/diagnose/residual_model.hpp"

namespace surefoot {

enum class Verdict : std::uint8_t {
  adequate,         // no significant mismatch, even with the nominal parameters
  parameters_only,  // calibration removes it
  missing_physics,  // named effects remove it
  unexplained,      // a significant mismatch remains that no effect models
  unfinished        // the search ended before its time: stopped, or out of its budget
};

/// An estimate with its 95 % interval.
struct FittedValue {
  std::string name, unit;
  double value = 0, low = 0, high = 0;
  bool at_bound = false;  // of the search, other than 0: it may be larger still
  double least = -std::numeric_limits<double>::infinity(), most = -least;  // bounds of the search
};

struct CalibratedParameter {
  FittedValue fit;
  double nominal = 0;
  bool at_bound = false, fixed = false;
};

/// How far an output is off, in its own unit; simulated over whole held-out recordings.
struct ChannelMismatch {
  std::string output, unit;
  double rmse_nominal = 0, rmse_calibrated = 0, rmse_after = 0;
  double noise = 0;    // standard deviation of what no model can predict, as stated or as far as can be seen
  double p_value = 1;  // that the calibrated model is off by chance only
  bool noise_stated = false;
  double noise_amplification = 1;  // of the noise, in errors of predictions that follow the readings; 1 where none do
};

/// Where the mismatch is: a rule over features of the motion.
struct MismatchRegion {
  std::string rule;
  double share_of_excess = 0, share_of_samples = 0, p_value = 1;
};

struct MismatchInterval {
  std::string recording;
  double from = 0, to = 0;  // [s], or rows of a map
  double share_of_excess = 0;
};

struct Evidence {
  double gain = 0;  // share of the error that goes with this effect, both fitted to all recordings (1 - after / before)
  double gain_stderr = 0;
  double p_value = 1;
  double confidence = 0;  // posterior probability of it: of all structures that it is part of
};

struct FoundEffect {
  std::string name, attached_to, sentence;
  std::vector<FittedValue> parameters;
  Evidence evidence;
  std::string form, other;  // which variant of the effect, and the second state it acts on, if any
};

/// Effects that might have been chosen instead.
struct Alternative {
  std::vector<std::pair<std::string, std::string>> effects;  // name, attached to
  double fitted_rmse = 0;                                    // in units as in RecordingFit
  double probability = 0;                                    // posterior, of this structure among all that were tried
  bool indistinguishable = false;                            // these recordings cannot tell them from the chosen ones
  /// As fitted_rmse, each recording predicted from fits to the others; NaN: not computed.
  double held_out_rmse = std::numeric_limits<double>::quiet_NaN();
};

struct RecordingFit {
  std::string recording;
  double before = 0,
         after = 0;        // error in units of the noise, or of the output's standard deviation where that is unknown
  double fitted = 0;       // error after, where its own readings took part in the fit; else the same as `after`
  double independent = 0;  // count of independent errors: of all, those beyond their autocorrelation
  bool beyond_noise = false;  // `fitted` is significantly further off than noise explains
};

/// One held-out recording for pictures: rows x outputs, and the times.
struct Curve {
  std::string recording;
  Eigen::VectorXd time;
  Eigen::MatrixXd inputs, measured, nominal, before, after;  // channel x row
};

/// What the recordings themselves forbid to see, or what is wrong with them; one sentence each.
struct Remark {
  std::string recording, text;
};

/// A fault of the log, not of the machine, that would pass for missing physics.
struct LogFault {
  std::string kind = {};       // sign_flipped, angle_unit, time_unit, columns_swapped, clock_offset, clock_skew,
                               // stuck_sensor, clipped, dropped_samples or odd_recording
  std::string recording = {};  // empty: all
  std::string channel = {};    // input or output; empty: the time, or all of it
  double size = 0;             // how much a clock is off, a factor, or how many rows
  std::string unit = {};
  std::string sentence = {}, cure = {};
  bool repaired = false;
};

/// What the noise of an output is like beyond white and of constant size.
struct NoiseFinding {
  std::string output, name;  // speed_dependent_noise or correlated_noise
  std::vector<FittedValue> parameters;
  double gain = 0;  // in log-likelihood on held-out recordings over noise without it [nat per sample]
  double p_value = 1;
  std::string sentence;
};

/// The smallest effect that would have been found, for a clean verdict.
struct DetectionLimit {
  std::string name, attached_to;
  FittedValue smallest;
};

/// A forest that corrects what is simulated, offered where no effect explains a mismatch.
struct ForestResidual {
  bool tried = false, kept = false;  // kept only if recordings it has not seen are simulated better with it
  double gain = 0, gain_stderr = 0;  // share of the error that goes, cross-validated on the recordings to fit
  double held_out_before = std::numeric_limits<double>::quiet_NaN();  // errors on the held-out recordings
  double held_out_after = std::numeric_limits<double>::quiet_NaN();
  ResidualModel model;  // of the model with the effects that were found
};

struct Diagnosis {
  std::string model;
  bool complete = true;  // false: the search was stopped, or ran out of its budget
  Verdict verdict = Verdict::adequate;
  std::string sentence;
  std::vector<std::string> fit, select, held_out;  // names of recordings
  std::vector<Remark> remarks;
  std::vector<LogFault> log_faults;
  std::vector<CalibratedParameter> parameters;  // of the model without effects
  std::vector<CalibratedParameter> augmented_parameters;
  std::vector<std::string> correlated;  // pairs of parameters the recordings hardly separate
  std::string noise_sentence;           // measurement noise, or process noise that accumulates
  std::vector<NoiseFinding> noise_findings;
  std::vector<ChannelMismatch> channels;
  std::vector<MismatchRegion> regions;
  std::vector<MismatchInterval> intervals;
  std::vector<FoundEffect> effects;
  std::vector<FoundEffect> known_effects;  // that the model had before, with parameters of the augmented fit
  std::vector<Alternative> alternatives;
  std::vector<DetectionLimit> limits;
  double probability = 1;          // posterior, of the effects that are named, or that there is none
  double probability_of_none = 0;  // that none of the structures that were fitted is all of what is missing
  std::string next_experiment;
  double training_before = 0, training_after = 0;  // errors, in units as in RecordingFit
  double held_out_before = 0, held_out_after = 0;
  double held_out_forest = std::numeric_limits<double>::quiet_NaN();  // a forest on residuals instead of effects
  ForestResidual forest_residual;
  double noise_floor = std::numeric_limits<double>::quiet_NaN();  // NaN: cannot be told
  double noise_ratio = std::numeric_limits<double>::quiet_NaN();  // held out, each output in units of what noise leaves
                                                                  // of it; NaN: the same
  double gain_low = 0, gain_high = 0;            // 95 % interval of held_out_after / held_out_before over recordings
  std::vector<RecordingFit> per_recording;
  std::vector<Curve> curves;
  int integration_order = 4;           // with which all this was simulated, see Integration
  double integration_step = 0;         // [s]
  std::vector<InputHold> input_holds;  // as the model says or as recordings show
  std::vector<bool> freed_states;      // by state: the model said where it begins, recordings say otherwise
  double seconds = 0;
  std::uint64_t seed = 0;
};

}  // namespace surefoot

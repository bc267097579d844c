// The pipeline: the stages of a diagnosis, one after the other.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/verdict/alternatives.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"
#include "surefoot/diagnose/verdict/held_out_check.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

/// Binds the user's simulator to recordings.
using BindSimulator = std::function<BoundSimulator(std::vector<Recording>)>;

/// Of the time that is given: what calibration and search may take.
inline constexpr double search_share = 0.85;

/// How a diagnosis is run: what every stage may ask for.
struct RunContext {
  const DiagnoseOptions& options;
  const Parallel& parallel;
  std::uint64_t seed = 1;
  std::stop_token stop = {};
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();

  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); }
  bool has_ended() const { return stop.stop_requested() || seconds() > options.max_seconds; }
  /// The rest of the time is for fits without each held-out recording: unless these are made, errors are of recordings
  /// that were fitted.
  bool search_has_ended() const { return has_ended() || seconds() > search_share * options.max_seconds; }
  void progress(std::string_view stage, double share, std::string_view best = "") const {
    if (options.on_progress) options.on_progress(stage, share, best);
  }
};

/// Checks recordings, takes outliers out of them and says in remarks what cannot be seen in them. Throws DiagnoseError
/// if one does not fit the simulator.
std::vector<Remark> screen_recordings(const SimulatorInfo& info, std::vector<Recording>& recordings);

/// Names faults of the log, and repairs them if that is asked for.
std::vector<LogFault> examine_recordings(const BindSimulator& bind, std::vector<Recording>& recordings,
                                         const RunContext& run);

/// All effects that may be named: those of the library and the user's own.
std::vector<Effect> nameable_effects(const DiagnoseOptions& options);

/// The simulator as it is, with the effects that are part of the model already.
Hypothesis nominal_with_known(const BoundSimulator& bound, const DiagnoseOptions& options);

/// Few recordings are cut into parts, unless those to hold out are named.
std::vector<Recording> cut_few_recordings(const BindSimulator& bind, std::vector<Recording> recordings,
                                          const RunContext& run);

/// Holds recordings out, or each in turn.
EstimationSetup hold_out_recordings(const BindSimulator& bind, std::vector<Recording> recordings,
                                    const RunContext& run);

/// Fills in which recordings are for what.
void name_recordings(const EstimationSetup& setup, Diagnosis& diagnosis);

/// The model before and after its parameters were calibrated.
struct Calibration {
  Hypothesis nominal;  // with the initial states of the training recordings
  Fit calibrated;
  std::vector<SimulatedRun> training_runs;  // of the calibrated model
};

/// Calibrates, with an integration that is fine enough and in the way the noise asks for: fills in noise, integration,
/// weighting and sizes of the setup.
Calibration calibrate_model(EstimationSetup& setup, const RunContext& run);

/// Effects that may be missing, at the places where they may be.
std::vector<AttachedEffect> candidate_effects(const EstimationSetup& setup, const Calibration& calibration,
                                              const RunContext& run);

/// The subject of the search. It keeps a reference to the setup.
SearchProblem search_problem(const EstimationSetup& setup, const Calibration& calibration, const RunContext& run);

/// Fills in parameters, effects and their evidence.
void describe_models(const EstimationSetup& setup, const FittedModels& models, const Selection& selection,
                     const RunContext& run, Diagnosis& diagnosis);

/// Fills in what might have been chosen instead, and how to tell it apart; returns the names of what cannot be told
/// apart from the choice.
std::vector<std::string> describe_alternatives(const Selection& selection, Diagnosis& diagnosis);

/// Fills in the smallest effects that would have been found, where nothing is missing.
void describe_limits(const EstimationSetup& setup, const FittedModels& models, const SearchProblem& problem,
                     const std::vector<AttachedEffect>& candidates, const RunContext& run, Diagnosis& diagnosis);

/// From the search to the finished diagnosis: the final check on held-out recordings, the verdict and everything that
/// is said about it.
void evaluate_selection(const EstimationSetup& setup, const Calibration& calibration, const SearchProblem& problem,
                        const Selection& selection, const std::vector<AttachedEffect>& candidates,
                        const RunContext& run, Diagnosis& diagnosis);

/// Runs all stages. The result does not depend on how `parallel` shares out the work.
Diagnosis run_pipeline(const BindSimulator& bind, const SimulatorInfo& info, std::vector<Recording> recordings,
                       const DiagnoseOptions& options, const Parallel& parallel, std::uint64_t seed,
                       std::stop_token stop);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/pipeline.ipp"
#endif

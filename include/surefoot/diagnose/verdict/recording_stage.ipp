// Definitions of surefoot/diagnose/verdict/recording_stage.hpp.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sensitive_starts.hpp"
#include "surefoot/diagnose/log_doctor/reading_faults.hpp"
#include "surefoot/diagnose/screening.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "surefoot/diagnose/verdict/prepare.hpp"
#include "surefoot/diagnose/verdict/recording_stage.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::string lost_rows_sentence(int lost) {
  return "rows are lost, " + std::to_string(lost) +
         " in all, by the steps of the clock: what was commanded in them is not known, and what it did may pass for "
         "missing physics";
}

SUREFOOT_ONCE std::vector<Remark> screen_recordings(const SimulatorInfo& info, std::vector<Recording>& recordings) {
  if (recordings.empty()) throw DiagnoseError("there is no recording to diagnose");
  std::vector<Remark> remarks;
  for (Recording& recording : recordings) {
    check_recording(info, recording);
    const auto outliers = remove_outliers(info, recording);
    append_items(remarks, outliers);
  }
  check_readings(info, recordings);
  const auto screened = screen(info, recordings);
  append_items(remarks, screened);
  int lost = 0;
  for (const Recording& recording : recordings) lost += lost_rows(recording);
  if (lost > 0 && !info.inputs.empty() && info.kind == SimulatorKind::ode) {
    remarks.push_back({"", lost_rows_sentence(lost)});
  }
  return remarks;
}

/// Parameters, fitted to all recordings before any is held out.
SUREFOOT_ONCE Hypothesis calibrate_alone(const BoundSimulator& bound, const RunContext& run) {
  FitProblem problem;
  problem.recordings = all_recordings(bound);
  problem.integration = bound.integration;
  problem.stopped = [run] { return run.search_has_ended(); };
  return calibrate(bound, nominal_with_known(bound, run.options), problem, run.options.starts, run.seed, run.parallel)
      .hypothesis;
}

SUREFOOT_ONCE std::vector<Recording> cut_few_recordings(const BindSimulator& bind, std::vector<Recording> recordings,
                                                        const RunContext& run) {
  const PreparationCriteria criteria;
  if (recordings.size() < criteria.enough && run.options.held_out.empty()) {
    const BoundSimulator whole = bind(recordings);
    const Hypothesis fitted = calibrate_alone(whole, run);
    const auto runs = simulate_all(whole, fitted, all_recordings(whole), whole.integration, run.parallel);
    const std::size_t parts = (criteria.parts + recordings.size() - 1) / recordings.size();
    std::vector<Recording> cut = cut_recordings(whole, fitted, runs, parts, criteria);
    if (cut.size() >= criteria.fewest) recordings = std::move(cut);
  }
  if (recordings.size() < 2) {
    throw DiagnoseError(
        "one short recording is not enough to tell what is missing: record at least two, or one of 60 rows");
  }
  return recordings;
}

/// All recordings, those that a simulation with these parameters finds sensitive in parts, each with a remark.
SUREFOOT_ONCE std::vector<Recording> cut_where_sensitive(const BoundSimulator& whole, const Hypothesis& hypothesis,
                                                         std::vector<Remark>& remarks) {
  constexpr double close = 0.5;  // Integration::follow of a simulation that stays near the readings
  Integration near = whole.integration;
  near.follow = close;
  std::vector<Recording> result;
  for (std::size_t r = 0; r < whole.recordings.size(); ++r) {
    const Recording& one = whole.recordings[r];
    const SimulatedRun motion = simulate(whole, hypothesis, r, near);
    std::vector<std::size_t> rows;
    if (motion.finite) rows = sensitive_rows(whole, hypothesis, r, motion.states);
    if (rows.empty()) {
      result.push_back(one);
      continue;
    }
    for (Recording& part : cut_at_rows(whole, r, motion.states, rows)) result.push_back(std::move(part));
    const double begin = one.time[static_cast<Eigen::Index>(rows.front())] - one.time[0];
    remarks.push_back({one.name, sensitive_recording_sentence(begin, rows.size() + 1)});
  }
  return result;
}

SUREFOOT_ONCE std::vector<Recording> cut_sensitive_recordings(const BindSimulator& bind,
                                                              std::vector<Recording> recordings, const RunContext& run,
                                                              std::vector<Remark>& remarks, const FoundModel* found) {
  const BoundSimulator whole = bind(std::move(recordings));
  const bool follows = whole.integration.follow > 0 || whole.info.kind == SimulatorKind::map;
  if (follows || !run.options.held_out.empty()) return whole.recordings;
  if (found != nullptr) return cut_where_sensitive(whole, with_found(whole, *found), remarks);
  Hypothesis hypothesis = nominal_with_known(whole, run.options);
  std::vector<Remark> first;
  std::vector<Recording> cut = cut_where_sensitive(whole, hypothesis, first);
  if (first.empty()) return cut;
  // the machine comes by other places with the parameters that the parts tell
  hypothesis.parameters = calibrate_alone(bind(std::move(cut)), run).parameters;
  return cut_where_sensitive(whole, hypothesis, remarks);
}

SUREFOOT_ONCE EstimationSetup hold_out_recordings(const BindSimulator& bind, std::vector<Recording> recordings,
                                                  const RunContext& run) {
  EstimationSetup setup{bind(std::move(recordings)), {}};
  setup.split = split_recordings(setup.bound.recordings, run.options.held_out, run.options.held_out_share,
                                 PreparationCriteria{}.folds, run.seed);
  setup.problem.recordings = setup.split.training;
  return setup;
}

SUREFOOT_ONCE void name_recordings(const EstimationSetup& setup, Diagnosis& diagnosis) {
  for (const std::size_t r : setup.split.training) diagnosis.fit.push_back(setup.bound.recordings[r].name);
  diagnosis.select = diagnosis.fit;  // structures are weighed on the same recordings
  for (const std::size_t r : setup.split.held_out) diagnosis.held_out.push_back(setup.bound.recordings[r].name);
}

}  // namespace surefoot::diagnosis

// Definitions of surefoot/diagnose/verdict/pipeline.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/growing_horizon.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/estimation/instability.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/text.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "surefoot/diagnose/verdict/evaluation_stage.hpp"
#include "surefoot/diagnose/verdict/pipeline.hpp"
#include "surefoot/diagnose/verdict/prepare.hpp"
#include "surefoot/diagnose/verdict/recording_stage.hpp"
#include "surefoot/diagnose/verdict/search_along_readings.hpp"

namespace surefoot::diagnosis {

/// The choice, fitted to all recordings, may need finer steps than the search took: it is fitted once more with these,
/// unless that leads astray.
SUREFOOT_ONCE void refit_with_finer_steps(EstimationSetup& setup, Selection& selection, const RunContext& run) {
  auto& [bound, split, noise, problem, noise_of_predictions, freed] = setup;
  Hypothesis& chosen = selection.chosen.hypothesis;
  if (chosen.effects.size() == selection.nominal.hypothesis.effects.size()) return;
  const auto finer =
      finer_integration(bound, chosen, problem.weighting.sigma, bound.integration, split.training, run.parallel);
  if (!finer) return;
  const double before = loss_of(bound, chosen, problem, run.parallel);
  FitProblem fine = problem;
  fine.integration = *finer;
  Fit refitted = fit(bound, chosen, fine, run.parallel);
  if (clearly_less * refitted.loss > before) refitted = grown_fit(bound, refitted, chosen, fine, run.parallel);
  if (clearly_less * refitted.loss > before) return;  // another valley, as of bounces in another order
  bound.integration = problem.integration = *finer;
  chosen = refitted.hypothesis;
}

SUREFOOT_ONCE void finish_fit(const EstimationSetup& setup, Hypothesis& chosen, const RunContext& run) {
  const Fit finished = fit(setup.bound, chosen, setup.problem, run.parallel);
  if (finished.ok) chosen = finished.hypothesis;
}

SUREFOOT_ONCE std::string shortening_sentence(Eigen::Index rows) {
  return "of so many rows only the first " + std::to_string(rows) +
         " of each recording were used; max_rows (--max-rows) takes more, in proportionally more time";
}

SUREFOOT_ONCE std::string no_time_to_begin_anew_sentence() {
  return "a fault of the log showed with what was found, and there was no time to begin anew with it repaired: "
         "repair the recording, or give more time (max_seconds, --budget)";
}

SUREFOOT_ONCE void remark_on_freed_states(const EstimationSetup& setup, const Hypothesis& chosen,
                                          Diagnosis& diagnosis) {
  diagnosis.freed_states = setup.freed;
  for (std::size_t i = 0; i < setup.freed.size(); ++i) {
    if (!setup.freed[i]) continue;
    const auto state = static_cast<Eigen::Index>(i);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::size_t r : setup.split.training) {
      const double off = chosen.initial[r][state] - setup.bound.recordings[r].initial[state];
      low = std::min(low, off);
      high = std::max(high, off);
    }
    diagnosis.remarks.push_back({"", freed_state_sentence(setup.bound.info.states[i], low, high)});
  }
}

SUREFOOT_ONCE FoundModel diagnose_recordings(const BindSimulator& bind, std::vector<Recording> recordings,
                                             const RunContext& run, Diagnosis& diagnosis, const FoundModel* begun) {
  recordings = cut_sensitive_recordings(bind, std::move(recordings), run, diagnosis.remarks, begun);
  recordings = cut_few_recordings(bind, std::move(recordings), run);
  EstimationSetup setup = hold_out_recordings(bind, std::move(recordings), run);
  name_recordings(setup, diagnosis);
  std::vector<Hypothesis> begin_with;
  if (begun != nullptr) begin_with.push_back(with_found(setup.bound, *begun));
  Searched found = search_effects(setup, run, diagnosis, begin_with);
  take_over_inputs(setup, found, run);
  revise_initial_states(setup, found, run, diagnosis);
  auto& [calibration, problem, candidates, selection] = found;
  diagnosis.complete = !run.search_has_ended();
  setup.problem = selection.fit;
  setup.problem.stopped = [run] { return run.has_ended(); };
  setup.bound.integration = setup.problem.integration;
  const bool found_any = selection.chosen.hypothesis.effects.size() > problem.known;
  if (found_any && !diagnosis.complete) {
    finish_fit(setup, selection.chosen.hypothesis, run);
    selection.chosen.errors.mean_squares =
        error_squares(setup.bound, selection.chosen.hypothesis, selection.fit.recordings, setup.bound.integration,
                      problem.scale, run.parallel)
            .mean_squares;
  }
  refit_with_finer_steps(setup, selection, run);
  remove_outliers_from(setup, selection.chosen.hypothesis, run, diagnosis);
  remark_on_freed_states(setup, selection.chosen.hypothesis, diagnosis);

  run.progress("evaluating", progress_evaluation);
  evaluate_selection(setup, calibration, problem, selection, candidates, run, diagnosis);
  const bool open = diagnosis.verdict == Verdict::unexplained || diagnosis.verdict == Verdict::unfinished;
  const bool named = found_any || !open;
  const Hypothesis& best = named ? selection.chosen.hypothesis : clearly_nearest(selection).hypothesis;
  return {best, setup.bound.sizes, setup.bound.integration.inputs, setup.freed, named, setup.bound.integration.follow};
}

/// The same with steps of at most so long [s], and simulations that follow the readings so (Integration); as it is for
/// 0.
SUREFOOT_ONCE BindSimulator with_integration(const BindSimulator& bind, double step, double follow) {
  return [bind, step, follow](std::vector<Recording> some) {
    BoundSimulator result = bind(std::move(some));
    if (step > 0) result.integration.step = step;
    if (follow > 0) result.integration.follow = follow;
    return result;
  };
}

/// Whether simulations are lost: what is left of whole recordings tells little of what is missing.
SUREFOOT_ONCE bool is_lost(const Diagnosis& diagnosis) {
  constexpr double far_off = 10;         // times what noise leaves
  constexpr double of_the_motion = 0.1;  // standard deviations of outputs
  return diagnosis.verdict == Verdict::unexplained && diagnosis.noise_ratio > far_off &&
         diagnosis.held_out_after > of_the_motion;
}

/// Whether predictions over short horizons show what explains them, where whole recordings do not.
SUREFOOT_ONCE bool shows_along_readings(const BindSimulator& bind, const std::vector<Recording>& recordings,
                                        const RunContext& run, FoundModel& found) {
  EstimationSetup setup = hold_out_recordings(bind, recordings, run);
  if (setup.bound.integration.follow > 0 || !can_be_guided(setup.bound, setup.problem)) return false;
  return search_along_readings(setup, run, found);
}

/// Suspected faults are true if the model with what is found without them names them beyond doubt in the recordings as
/// they were logged. Then `log` holds them, and this is the diagnosis without them. What was suspected in vain may take
/// half of the time.
SUREFOOT_ONCE std::optional<Diagnosis> diagnose_without_suspected(const BindSimulator& bind,
                                                                  const std::vector<Recording>& logged,
                                                                  LogExamination& log,
                                                                  const std::vector<Remark>& remarks,
                                                                  const RunContext& run) {
  constexpr double share = 0.5;  // of the time that is left
  if (log.suspected.empty()) return std::nullopt;
  DiagnoseOptions options = run.options;
  options.max_seconds = (1 - share) * run.seconds() + share * options.max_seconds;
  const RunContext part{options, run.parallel, run.seed, run.stop, run.began};
  Diagnosis diagnosis;
  diagnosis.remarks = remarks;
  const FoundModel found = diagnose_recordings(bind, log.without_suspected, part, diagnosis);
  if (run.search_has_ended()) return std::nullopt;
  LogExamination again = examine_with_effects(bind, logged, found, run);
  if (!is_named_again(log.suspected, again.faults)) return std::nullopt;
  log = std::move(again);
  diagnosis.log_faults = log.faults;
  return diagnosis;
}

/// Whether recordings are sensitive with what was found, so that a simulation may go another way, and parts of them
/// show no fault.
SUREFOOT_ONCE bool parts_have_no_fault(const BindSimulator& bind, const std::vector<Recording>& recordings,
                                       const FoundModel& found, const RunContext& run) {
  std::vector<Remark> cuts;
  const std::vector<Recording> parts = cut_sensitive_recordings(bind, recordings, run, cuts, &found);
  if (cuts.empty() || found.follow > 0) return false;
  const LogExamination of_parts = examine_with_effects(bind, parts, found, run);
  return of_parts.faults.empty() && !run.has_ended();
}

/// Stages after the log was examined. What was found may show more faults, or, where simulations are lost, what shows
/// along the readings may name an effect: with these all begins anew, if there is time for as much again.
SUREFOOT_ONCE Diagnosis diagnose_and_examine_again(const BindSimulator& bind, const std::vector<Recording>& logged,
                                                   LogExamination log, std::vector<Remark> remarks,
                                                   const RunContext& run) {
  bool begins_anew = false, goes_along = false;
  FoundModel along;  // what shows along the readings, tried on whole recordings
  BindSimulator bind_now = bind;
  const double examined = run.seconds();
  std::optional<Diagnosis> without_suspected = diagnose_without_suspected(bind, logged, log, remarks, run);
  bool confirmed = without_suspected.has_value();
  if (confirmed && run.options.repair && !run.has_time_for_as_much_again(examined)) {
    return std::move(*without_suspected);
  }
  while (true) {
    const double started = run.seconds();
    const std::vector<LogFault> considered = log.faults;
    Diagnosis diagnosis;
    diagnosis.remarks = remarks;
    const std::vector<Recording>& recordings = run.options.repair ? log.repaired : logged;
    const FoundModel found = diagnose_recordings(bind_now, recordings, run, diagnosis, goes_along ? &along : nullptr);
    const bool lost = !goes_along && is_lost(diagnosis) && run.has_time_for_as_much_again(started);
    if (lost && shows_along_readings(bind, recordings, run, along)) {
      goes_along = true;
      if (along.follow > 0) remarks.push_back({"", following_sentence(1 / along.follow, true)});
      bind_now = with_integration(bind, 0, along.follow);
      continue;
    }
    const bool found_any = found.hypothesis.effects.size() > run.options.known.size();
    LogExamination more;
    if (found_any && !begins_anew && !run.has_ended()) {
      more = examine_with_effects(bind, log.repaired, found, run);
      if (!more.faults.empty() && parts_have_no_fault(bind, log.repaired, found, run)) more = {};
    }
    const bool found_late = run.options.repair && !more.faults.empty();
    begins_anew = found_late && run.has_time_for_as_much_again(started);
    if (found_late && !begins_anew) diagnosis.remarks.push_back({"", no_time_to_begin_anew_sentence()});
    const bool named_again = is_named_again(log.faults, more.faults);
    if (named_again) {
      LogExamination again = examine_with_effects(bind, logged, found, run, log.faults);
      if (!run.has_ended()) log = std::move(again);  // what was cut short says nothing
    } else if (!more.faults.empty()) {
      append_items(log.faults, more.faults);
      log.repaired = std::move(more.repaired);
    }
    if (begins_anew) continue;
    const bool freed = std::find(found.freed.begin(), found.freed.end(), true) != found.freed.end();
    const bool in_doubt = ((found_any && found.named) || freed) && !named_again && !confirmed && !log.faults.empty();
    if (in_doubt) {
      confirmed = true;
      LogExamination again;
      if (!run.has_ended()) again = examine_with_effects(bind, logged, found, run, log.faults);
      if (run.has_ended()) {  // what was cut short says nothing
        withdraw_odd_recording(log);
      } else if (withdraw_faults(log, again, run.has_time_for_as_much_again(started))) {
        continue;
      }
    }
    // found too late to begin anew: named, but not repaired in what this diagnosis is made of
    for (LogFault& fault : log.faults) fault.repaired = fault.repaired && is_named_again(considered, {fault});
    diagnosis.log_faults = std::move(log.faults);
    return diagnosis;
  }
}

/// A simulation of a recording that its start does not tell may go another way, which looks like a fault of the log.
/// One that is cut where that happens shows whether there is any; then the recordings are these parts.
SUREFOOT_ONCE void examine_parts_as_well(const BindSimulator& bind, const RunContext& run,
                                         std::vector<Recording>& recordings, std::vector<Remark>& remarks,
                                         LogExamination& log) {
  if (log.faults.empty() && log.suspected.empty()) return;
  std::vector<Remark> cuts;
  std::vector<Recording> parts = cut_sensitive_recordings(bind, recordings, run, cuts);
  if (cuts.empty()) return;
  LogExamination of_parts = examine_recordings(bind, parts, run);
  if (!of_parts.faults.empty() || !of_parts.suspected.empty()) return;
  log = std::move(of_parts);
  recordings = std::move(parts);
  append_items(remarks, cuts);
}

/// As many steps a row as a simulator needs to run over these recordings, which are followed where they must be, with
/// a remark that says why.
SUREFOOT_ONCE Integration needed_integration(const BindSimulator& bind, const std::vector<Recording>& recordings,
                                             const RunContext& run, std::vector<Remark>& remarks) {
  BoundSimulator bound = bind(recordings);
  const Hypothesis nominal = nominal_with_known(bound, run.options);
  bound.integration = integration_that_runs(bound, nominal, run.parallel);
  const double follow = needed_follow(bound, nominal, run.parallel);
  if (follow > 0) remarks.push_back({"", following_sentence(1 / follow, moves_as_measured(bound, nominal))});
  bound.integration.follow = follow;
  return bound.integration;
}

SUREFOOT_ONCE Diagnosis run_pipeline(const BindSimulator& bind, const SimulatorInfo& info,
                                     std::vector<Recording> recordings, const DiagnoseOptions& options,
                                     const Parallel& parallel, std::uint64_t seed, std::stop_token stop) {
  check(options);
  const RunContext run{options, parallel, seed, stop};
  run.progress("screening", 0);
  std::vector<Remark> remarks = screen_recordings(info, recordings);
  sort_recordings(recordings);
  const Eigen::Index kept = shorten_recordings(recordings, options.max_rows);
  if (kept > 0) remarks.push_back({"", shortening_sentence(kept)});
  const Integration needed = needed_integration(bind, recordings, run, remarks);
  const BindSimulator bind_to_run = with_integration(bind, needed.step, needed.follow);
  LogExamination log = examine_recordings(bind_to_run, recordings, run);
  examine_parts_as_well(bind_to_run, run, recordings, remarks, log);
  const std::string warning = fault_preface(log.faults);
  try {
    Diagnosis diagnosis = diagnose_and_examine_again(bind_to_run, recordings, std::move(log), std::move(remarks), run);
    diagnosis.model = info.name;
    diagnosis.seed = seed;
    diagnosis.sentence = fault_preface(diagnosis.log_faults) + diagnosis.sentence;
    diagnosis.seconds = run.seconds();
    run.progress("done", 1, diagnosis.sentence);
    return diagnosis;
  } catch (const DiagnoseError& error) {  // which may well come of the fault
    throw DiagnoseError(warning + error.what());
  }
}

}  // namespace surefoot::diagnosis

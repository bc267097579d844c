// Definitions of surefoot/diagnose/verdict/pipeline.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/growing_horizon.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/estimation/instability.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/sensitive_starts.hpp"
#include "surefoot/diagnose/estimation/standard_errors.hpp"
#include "surefoot/diagnose/log_doctor/reading_faults.hpp"
#include "surefoot/diagnose/residual_tests/noise.hpp"
#include "surefoot/diagnose/screening.hpp"
#include "surefoot/diagnose/selection/search.hpp"
#include "surefoot/diagnose/text.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "surefoot/diagnose/verdict/detection_limits.hpp"
#include "surefoot/diagnose/verdict/evaluate.hpp"
#include "surefoot/diagnose/verdict/evidence.hpp"
#include "surefoot/diagnose/verdict/locate_mismatch.hpp"
#include "surefoot/diagnose/verdict/none_of_these.hpp"
#include "surefoot/diagnose/verdict/pipeline.hpp"
#include "surefoot/diagnose/verdict/prepare.hpp"
#include "surefoot/diagnose/verdict/search_along_readings.hpp"

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

SUREFOOT_ONCE void describe_models(const EstimationSetup& setup, const FittedModels& models, const Selection& selection,
                                   const RunContext& run, Diagnosis& diagnosis) {
  const BoundSimulator& bound = setup.bound;
  const Hypothesis &calibrated = models.calibrated.hypothesis, &chosen = models.chosen.hypothesis;
  const std::size_t known = calibrated.effects.size();
  const StandardErrors without = standard_errors(bound, calibrated, setup.problem, run.parallel);
  const bool found_any = chosen.effects.size() > known;
  const StandardErrors errors = found_any ? standard_errors(bound, chosen, setup.problem, run.parallel) : without;
  diagnosis.parameters = calibrated_parameters(bound, calibrated, without);
  diagnosis.correlated = correlated_pairs(bound, without);
  diagnosis.augmented_parameters = calibrated_parameters(bound, chosen, errors);
  diagnosis.noise_sentence = noise_sentence(setup.noise);
  diagnosis.integration_order = bound.integration.order;
  diagnosis.integration_step = bound.integration.step;
  const std::vector<InputHold>& found = bound.integration.inputs;
  for (std::size_t i = 0; i < bound.info.inputs.size(); ++i) {
    const InputInfo& input = bound.info.inputs[i];
    const InputHold hold = hold_of(bound.info, found, i), said = input.hold.value_or(InputHold::zero_order);
    diagnosis.input_holds.push_back(hold);
    if (hold != said) diagnosis.remarks.push_back({"", hold_sentence(input.name, hold, said)});
  }
  for (std::size_t e = 0; e < chosen.effects.size(); ++e) {
    FoundEffect found = describe(bound, chosen, e, &errors);
    if (e < known) {
      diagnosis.known_effects.push_back(std::move(found));
      continue;
    }
    found.evidence = evidence_for(selection, e - known);
    diagnosis.effects.push_back(std::move(found));
  }
}

SUREFOOT_ONCE std::vector<std::string> describe_alternatives(const Selection& selection, Diagnosis& diagnosis) {
  const Alternatives others = find_alternatives(selection);
  diagnosis.probability = selection.probability;
  diagnosis.alternatives = others.list;
  if (!others.indistinguishable.empty()) {
    diagnosis.next_experiment =
        next_experiment(selection.chosen.hypothesis, others.indistinguishable.front().hypothesis);
  }
  return others.ties;
}

/// Probabilities of structures beside that of none of them.
SUREFOOT_ONCE void weigh_against_none(const EstimationSetup& setup, const Selection& selection,
                                      const SearchProblem& problem, Diagnosis& diagnosis) {
  if (setup.noise != NoiseKind::measurement) return;  // noise adds up on the way
  Eigen::VectorXd noise(static_cast<Eigen::Index>(diagnosis.channels.size()));
  for (std::size_t k = 0; k < diagnosis.channels.size(); ++k) {
    noise[static_cast<Eigen::Index>(k)] = diagnosis.channels[k].noise;
  }
  diagnosis.probability_of_none = probability_of_none(selection, noise, problem);
  diagnosis.probability *= 1 - diagnosis.probability_of_none;
  for (Alternative& other : diagnosis.alternatives) other.probability *= 1 - diagnosis.probability_of_none;
}

SUREFOOT_ONCE void describe_limits(const EstimationSetup& setup, const FittedModels& models,
                                   const SearchProblem& problem, const std::vector<AttachedEffect>& candidates,
                                   const RunContext& run, Diagnosis& diagnosis) {
  if (!diagnosis.effects.empty() || diagnosis.verdict == Verdict::unexplained) return;
  FitProblem few = setup.problem;
  few.recordings = problem.screened;
  const Hypothesis& base = models.calibrated.hypothesis;
  diagnosis.limits =
      detection_limits(setup.bound, propose(setup.bound, base, few, candidates, base.effects.size(), run.parallel));
}

SUREFOOT_ONCE void name_recordings(const EstimationSetup& setup, Diagnosis& diagnosis) {
  for (const std::size_t r : setup.split.training) diagnosis.fit.push_back(setup.bound.recordings[r].name);
  diagnosis.select = diagnosis.fit;  // structures are weighed on the same recordings
  for (const std::size_t r : setup.split.held_out) diagnosis.held_out.push_back(setup.bound.recordings[r].name);
}

/// The least error on recordings that were not seen, of other structures and of a forest.
SUREFOOT_ONCE double least_of_others(const Selection& selection, const Diagnosis& diagnosis) {
  double least = std::numeric_limits<double>::infinity();
  for (const EvaluatedHypothesis& other : selection.alternatives) least = std::fmin(least, other.predicted);
  return std::fmin(least, diagnosis.held_out_forest);
}

/// Whether inputs drive states none of which forces may act on.
SUREFOOT_ONCE bool no_speed_is_known(const BoundSimulator& bound) {
  const SimulatorInfo& info = bound.info;
  const bool driven = info.kind == SimulatorKind::ode && !info.inputs.empty() && !info.planar;
  return driven && !holds_for_any(bound.structure.velocity, [](bool is) { return is; });
}

SUREFOOT_ONCE void evaluate_selection(const EstimationSetup& setup, const Calibration& calibration,
                                      const SearchProblem& problem, const Selection& selection,
                                      const std::vector<AttachedEffect>& candidates, const RunContext& run,
                                      Diagnosis& diagnosis) {
  const VerdictCriteria verdict;
  const auto& training = setup.split.training;
  const FittedModel calibrated = fitted_model(setup, calibration.calibrated.hypothesis, run.parallel);
  const CheckedChoice choice = check_on_held_out(setup, calibrated, selection, HeldOutCriteria{}, run.parallel);
  const FittedModels models{simulate_model(setup, calibration.nominal, run.parallel), calibrated, choice.chosen};
  if (choice.rejected) diagnosis.remarks.push_back({"", rejection_sentence()});
  if (run.has_ended()) diagnosis.remarks.push_back({"", not_held_out_sentence()});

  const ErrorSquares nominal =
      error_squares(setup.bound, calibration.nominal, training, setup.bound.integration, problem.scale, run.parallel);
  const Comparison calibration_gain = gain_of(nominal, selection.nominal.errors, 0);
  evaluate_errors(setup, models, diagnosis, run.seed);
  if (setup.noise != NoiseKind::final_pose) {
    diagnosis.held_out_forest = corrected_error(setup, calibrated, run.parallel, run.seed);
  }
  cap_noise(diagnosis, least_of_others(choice.selection, diagnosis), error_scale(setup.bound));
  mark_beyond_noise(diagnosis, verdict);
  const std::string overstated = overstated_noise_sentence(diagnosis.channels);
  if (!overstated.empty()) diagnosis.remarks.push_back({"", overstated});
  diagnosis.verdict =
      decide(gather_evidence(setup, models, diagnosis, calibration_gain, verdict, run.parallel, run.seed), verdict);

  describe_models(setup, models, choice.selection, run, diagnosis);
  const std::vector<std::string> ties = describe_alternatives(choice.selection, diagnosis);
  weigh_against_none(setup, choice.selection, problem, diagnosis);
  MismatchLocation location = locate_mismatch(setup, calibrated, run.seed);
  diagnosis.regions = std::move(location.first);
  diagnosis.intervals = std::move(location.second);
  offer_forests(setup, models, diagnosis, run.parallel, run.seed);
  describe_limits(setup, models, problem, candidates, run, diagnosis);
  diagnosis.sentence = verdict_sentence(diagnosis, ties);
  const bool as_many_as_may_be = static_cast<int>(diagnosis.effects.size()) >= run.options.max_effects;
  const bool open = diagnosis.verdict == Verdict::unexplained || diagnosis.verdict == Verdict::unfinished;
  if (open && !diagnosis.effects.empty() && as_many_as_may_be) {
    diagnosis.remarks.push_back({"", most_effects_sentence(run.options.max_effects)});
  }
  if (diagnosis.verdict == Verdict::unexplained) {
    const std::vector<int>& together = setup.bound.structure.moved_together;
    if (!together.empty()) diagnosis.remarks.push_back({"", moved_together_sentence(setup.bound.info, together)});
    if (no_speed_is_known(setup.bound)) diagnosis.remarks.push_back({"", no_speed_sentence()});
    return;  // what is left of it would pass for noise
  }
  diagnosis.noise_findings = find_noise(setup.bound, choice.chosen.hypothesis, training, setup.noise, run.parallel);
}

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
  for (const Remark& cut : cuts) remarks.push_back(cut);
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

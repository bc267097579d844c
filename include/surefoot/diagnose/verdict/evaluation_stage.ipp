// Definitions of surefoot/diagnose/verdict/evaluation_stage.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/marginal_likelihood.hpp"
#include "surefoot/diagnose/estimation/standard_errors.hpp"
#include "surefoot/diagnose/residual_tests/noise.hpp"
#include "surefoot/diagnose/selection/propose.hpp"
#include "surefoot/diagnose/verdict/alternatives.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "surefoot/diagnose/verdict/detection_limits.hpp"
#include "surefoot/diagnose/verdict/evaluate.hpp"
#include "surefoot/diagnose/verdict/evaluation_stage.hpp"
#include "surefoot/diagnose/verdict/evidence.hpp"
#include "surefoot/diagnose/verdict/held_out_check.hpp"
#include "surefoot/diagnose/verdict/locate_mismatch.hpp"
#include "surefoot/diagnose/verdict/none_of_these.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

/// Fills in parameters, effects and their evidence.
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

/// Fills in what might have been chosen instead, and how to tell it apart; returns the names of what cannot be told
/// apart from the choice.
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

/// Fills in the smallest effects that would have been found, where nothing is missing.
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

}  // namespace surefoot::diagnosis

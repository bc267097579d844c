// Criterion of the selection: the posterior probability of whole structures.
//
// The density of a recording is a Student t density of its errors, whose scale is that of the recording and output
// itself around the one of all; n errors with an autocorrelation time of m rows count as n / m. With the Occam factor
// of the parameters this is Laplace's approximation of the marginal likelihood; the prior probability falls with each
// effect by the number of candidates. Structures are weighted by these densities, summed over recordings that are drawn
// anew (Bayesian bootstrap, as in pseudo-BMA+; Yao, Vehtari, Simpson & Gelman, "Using stacking to average Bayesian
// predictive distributions", Bayesian Analysis 13(3), 2018): what a few recordings alone decide stays uncertain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "surefoot/diagnose/estimation/marginal_likelihood.hpp"

namespace surefoot::diagnosis {

/// The meaning of "probable". Densities are in nat.
struct SelectionCriteria {
  int max_effects = 4;  // to combine; more of them can rarely be told apart

  // Prior probability of a structure:
  double form_cost = 1;       // [nat] of each parameter and of a memory: longer formulas are rarer
  double bound_cost = 50;     // [nat] of a parameter at its bound, of a size that hardly makes sense
  double bound_share = 0.01;  // of its range, nearer to which a parameter counts as at its bound

  // Predictive density:
  double degrees = 12;        // of freedom of the prior of a recording's own scale: it differs by about a fifth
  double least_error = 1e-3;  // of the output's standard deviation: smaller errors are those of the integration
  double form_error = 0.05;   // of the error without effects: the form of an effect is never quite that of the machine
  double tolerated_form = 0.4;  // of the noise's mean square: no more, where another structure leaves no more than that

  // Decision:
  double named_odds = 20;      // that something is missing, from which on it is named: 5 % to be wrong
  double tie_odds = 8;         // of the best structure against another one, below which they cannot be told apart
  std::uint32_t rounds = 400;  // of the bootstrap over recordings: shares are off by 2.5 % at most
  std::uint64_t seed = 1;      // of the same: always the same draws

  // Residuals hold what noise does not:
  double structure_significance = 0.02;
  double structure_share = 0.03;  // of their mean square: less is not worth a parameter

  // Proposals that get no fit:
  double least_distinct = 0.01;  // share of a signature beyond the model's parameters: below, they do it, unless what
                                 // is left of it is worth a parameter
  double unstructured_proposal_gain =
      0.012;  // share of the squared residuals, if these look like noise: more than chance

  // Inputs and signals that are multiples of one before:
  double collinear = 1 - 1e-9;  // cosine; what rounding leaves of 1
};

/// How much is tried: time against thoroughness. No result is believed or refused by these.
struct SearchEffort {
  std::size_t shortlist = 14;          // proposals that get a fit
  std::size_t max_shortlist = 50;      // of small problems
  double shortlist_rows = 6000;        // of the recordings, up to which the list is longer in proportion
  std::size_t further_shortlist = 14;  // of these beside effects that were found: there, signatures say more
  double underestimated = 5;           // multiple of what its signature says that an effect may explain when fitted
  std::size_t rows = 4000;             // of the recordings that the search looks at; what it finds is fitted to all
  std::size_t finalists = 6;           // fits of a first effect that are finished and evaluated
  std::size_t further_finalists = 5;   // the same beside effects that were found
  std::size_t beam = 3;                // structures that are each extended by a further effect
  double hopeless = 15;                // [nat] behind the best one: not extended, not fitted again
  std::size_t screening = 5;           // recordings that proposals are made from
  std::size_t screening_of_few = 1000;       // the same where each has a pose only, or all are short:
  double screening_rows = 3000;              // together; of so few rows, each recording shows something of its own
  int first_iterations = 4;                  // of a fit, before the weakest are given up
  std::size_t second_look = 2;               // times as many fits as are finished are continued before that choice,
  int second_iterations = 8;                 // for so long
  double weak_start = 0.3;                   // of the strength that the linear guess says, if that was too bold:
  double bold_loss = 0.97;                   // it was, if the loss is still above this
  std::size_t more_starts = 2;               // for effects that have no strength
  std::size_t scattered_points = 12;         // for the model's parameters beside the first effect
  std::size_t restarted = 2;                 // of the best structures, where they leave more than noise
  std::size_t restarts = 8;                  // of each of these
  int restart_iterations = 4;                // of a restart, before all but the best are given up
  std::size_t pairs = 10;                    // of proposals that get a fit
  std::size_t combined = 6;                  // single effects that are tried with each other
  std::size_t pair_finalists = 3;            // fits of pairs that are finished and evaluated
  std::size_t compared_shortlist = 8;        // for what may stand in an effect's place
  std::size_t compared_finalists = 3;        // fits of these that are finished and evaluated
  std::size_t predicted = 8;                 // structures that are compared by their predictions
};

/// A fitted hypothesis with its errors.
struct EvaluatedHypothesis {
  Hypothesis hypothesis;
  double loss = std::numeric_limits<double>::infinity();  // on the recordings of the fit
  ErrorSquares errors;
  double log_prior = 0;  // of the structure, and the Occam factor of its parameters [nat]
  double predicted = std::numeric_limits<double>::quiet_NaN();  // root mean square of the errors of predictions

  /// Parameters of all effects.
  std::size_t parameter_count() const;
};

/// The subject of a search, and how to go about it.
struct SearchProblem {
  FitProblem fit;                     // all recordings but those held out
  Weighting scale;                    // in units of which errors are compared; the same for all hypotheses
  Eigen::VectorXd least;              // as in ErrorSquares, for all hypotheses
  Eigen::VectorXd noise = {};         // mean square of the noise by output, in the unit of errors; 0: not known
  std::vector<std::size_t> screened;  // recordings that screen proposals
  std::optional<Integration> screening = {};  // of these fits, where coarser than that of `fit`
  Hypothesis nominal;                 // the same without calibration: a second place to start from
  std::vector<std::vector<std::size_t>> folds = {};  // of the recordings, each to be predicted from the others
  bool scatter = true;                // start the model's parameters from elsewhere too, beside a first effect
  std::size_t known = 0;              // effects that are part of the model already: the first ones, never removed
  std::size_t candidates = 1;         // effects and places that may be tried
  /// Log odds of another explanation than effects, against none: a search whose first effects do worse ends there.
  double rival = -std::numeric_limits<double>::infinity();
  /// Whether the residuals of a hypothesis, on the recordings that it was fitted to, still hold what noise does not;
  /// where not, only strong proposals get a fit.
  std::function<bool(const Hypothesis&, const FitProblem&)> structured = [](const Hypothesis&, const FitProblem&) {
    return true;
  };
  std::function<void(const std::string&, double)> on_progress = [](const std::string&, double) {};
  std::function<bool()> stopped = [] { return false; };
  SelectionCriteria criteria = {};
  SearchEffort effort = {};
};

/// A fit that is only compared with others, of so many iterations: on the recordings that screen, in coarser steps.
FitProblem screening_fit(const SearchProblem& problem, int iterations);

/// Mean squares over all recordings, by output.
Eigen::VectorXd pooled(const ErrorSquares& errors);

/// Variance of weighted errors that are as small as those of the integration.
double least_variance(const SearchProblem& problem);

/// Whether the catalogue says that one of two effects may be taken for the other.
bool may_be_confused(const Effect& a, const Effect& b);

/// Whether two effects have one name, or may be taken for each other.
bool is_like(const Effect& a, const Effect& b);

/// Whether all that a structure has beyond a smaller one may only mend the form of what that has: it acts at the same
/// place as some effect of it, along a coupling, or is like it. A constant has no form to be mended.
bool may_mend_form(const Hypothesis& larger, const Hypothesis& smaller);

/// Differences to a hypothesis that mean nothing to one with fewer effects, unless a further one may mend the form of
/// another. What leaves only noise is of the right form: beside that, errors of form are as small as a diagnosis
/// tolerates them.
Eigen::VectorXd negligible_beside(const ErrorSquares& errors, const SearchProblem& problem);

/// Whether a structure leaves no more of any output than the noise, as far as that is known, and what a diagnosis
/// tolerates: its effects are of the right form.
bool leaves_only_noise(const EvaluatedHypothesis& one, const SearchProblem& problem);

/// What a number that each recording has for itself costs, such as where a state begins [nat]: half the log of its
/// independent errors, summed over recordings (BIC).
double cost_of_own_numbers(const ErrorSquares& errors);

/// Measures a fit on each of its recordings.
EvaluatedHypothesis evaluate_fit(const BoundSimulator& bound, const Fit& fitted, const SearchProblem& problem,
                                 const Parallel& parallel);

/// Differences of the mean square, by output, that mean nothing: they may come of the form of effects.
Eigen::VectorXd negligible_differences(const ErrorSquares& without_effects, const SelectionCriteria& criteria);

/// Whether a parameter, of an effect or of the model, is at a bound, which no size that makes sense is; a strength of
/// zero is none.
bool is_at_bound(const Hypothesis& hypothesis, const Variable& variable, const SelectionCriteria& criteria);

/// Log of the prior probability of the effects beyond the first `known` [nat], but for a constant.
double log_prior(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t known, std::size_t candidates,
                 const SelectionCriteria& criteria);

/// What a hypothesis is compared with that comes closer: one of as many effects, one with more of which those mend the
/// form of others, or one with more elsewhere.
enum class Beside { as_many, mended_form, more_elsewhere };

/// Log density of each recording [nat], but for a constant that is the same for all hypotheses with the same
/// reference: the closest of those to be compared. Differences of mean squares that may be errors of form last for all
/// of a recording: they count as one error. Such are those up to `reference.least`; beside what leaves only noise,
/// which is of the right form, those up to `least_elsewhere`, and none where effects are as many.
std::vector<double> log_densities(const ErrorSquares& errors, const ErrorSquares& reference,
                                  const SelectionCriteria& criteria, Beside beside = Beside::mended_form);

/// The one with the largest sum of log densities and log prior, in units that make all comparable: a good reference.
std::size_t best_of(const std::vector<EvaluatedHypothesis>& evaluated, const SelectionCriteria& criteria);

/// Log of the posterior odds of `a` against `b` [nat], all recordings taken as they are.
double log_odds(const EvaluatedHypothesis& a, const EvaluatedHypothesis& b, const SelectionCriteria& criteria);

/// Lets all differences between errors count.
void forget_errors_of_form(ErrorSquares& errors);

/// The same of two forms of one structure: what may be an error of form counts as well.
double log_odds_of_forms(EvaluatedHypothesis a, EvaluatedHypothesis b, const SelectionCriteria& criteria);

/// Posterior probabilities, which add up to 1. Cost: rounds * recordings * hypotheses.
std::vector<double> probabilities(const std::vector<EvaluatedHypothesis>& evaluated, const SelectionCriteria& criteria);

/// The effects of a hypothesis, each with its place, whatever their form, in alphabetical order.
std::vector<std::string> structure_of(const Hypothesis& hypothesis);

/// The same effects at the same places, perhaps in another form or order.
bool same_structure(const Hypothesis& a, const Hypothesis& b);

/// The same effects at the same places, in the same forms.
bool same_effects(const Hypothesis& a, const Hypothesis& b);

/// Whether one of the others has the same effects.
bool is_among(const Hypothesis& one, const std::vector<Hypothesis>& others);

/// Whether all effects of one structure are in another one, which has more.
bool is_part_of(const Hypothesis& part, const Hypothesis& whole);

/// Whether a structure is hardly closer than one of the pool that lacks some of its effects: what can be said of it is
/// said of that one.
bool holds_idle_effect(const EvaluatedHypothesis& one, const std::vector<EvaluatedHypothesis>& pool);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/criterion.ipp"
#endif

// Posterior probabilities of structures: priors, densities, and what these say together.
#include "surefoot/diagnose/selection/criterion.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "surefoot/diagnose/effects/cogging.hpp"
#include "surefoot/diagnose/effects/constant_force.hpp"
#include "surefoot/diagnose/effects/coulomb_friction.hpp"
#include "surefoot/diagnose/effects/cubic_stiffness.hpp"
#include "surefoot/diagnose/effects/first_order_lag.hpp"
#include "surefoot/diagnose/effects/hysteresis.hpp"
#include "surefoot/diagnose/effects/not_settled.hpp"
#include "surefoot/diagnose/effects/quadratic_drag.hpp"
#include "surefoot/diagnose/effects/quantization.hpp"
#include "surefoot/diagnose/effects/sensor_bias.hpp"
#include "surefoot/diagnose/effects/sensor_delay.hpp"
#include "surefoot/diagnose/effects/sensor_drift.hpp"
#include "surefoot/diagnose/effects/stribeck_friction.hpp"
#include "surefoot/diagnose/effects/viscous_friction.hpp"
#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

const SelectionCriteria selection_criteria;

// Errors of one output, with this mean square in each of some recordings of 100 cells.
ErrorSquares errors_of(const std::vector<double>& mean_squares, double cells = 100, double memory = 1) {
  const auto rows = static_cast<Eigen::Index>(mean_squares.size());
  return {Eigen::Map<const Eigen::VectorXd>(mean_squares.data(), rows), Eigen::VectorXd::Constant(rows, cells),
          Eigen::VectorXd::Constant(1, memory)};
}

EvaluatedHypothesis evaluated(const std::vector<double>& mean_squares, double log_prior = 0) {
  EvaluatedHypothesis one;
  one.errors = errors_of(mean_squares);
  one.log_prior = log_prior;
  return one;
}

// By how much more probable the reference is than errors of one recording [nat].
double behind(double mean_square, double cells, double memory, double least) {
  ErrorSquares reference = errors_of({1}, cells, memory);
  reference.least = Eigen::VectorXd::Constant(1, least);
  return log_densities(reference, reference, selection_criteria)[0] -
         log_densities(errors_of({mean_square}, cells, memory), reference, selection_criteria)[0];
}

TEST_CASE("the larger the errors, the less probable they are, and the more so the more of them there are") {
  CHECK(behind(1, 100, 1, 0) == 0);
  CHECK(behind(0.9, 100, 1, 0) < 0);
  CHECK(behind(1.1, 100, 1, 0) > 0);
  CHECK(behind(1.2, 100, 1, 0) > behind(1.1, 100, 1, 0));
  CHECK(behind(1.1, 1000, 1, 0) > behind(1.1, 100, 1, 0));
}

TEST_CASE("of errors that depend on each other only as many count as are independent") {
  CHECK(behind(1.5, 1000, 10, 0) == doctest::Approx(behind(1.5, 100, 1, 0)));
  CHECK(behind(1.5, 1000, 1, 0) > 1.1 * behind(1.5, 1000, 10, 0));
}

TEST_CASE("a difference that may come of the form of effects counts as one error, however many cells there are") {
  const double small = behind(1.1, 100, 1, 0.2);
  CHECK(small > 0);
  CHECK(small < 0.1);
  CHECK(behind(1.1, 1e6, 1, 0.2) == doctest::Approx(small));
  CHECK(behind(0.9, 1e6, 1, 0.2) > -0.1);
  CHECK(behind(1.4, 100, 1, 0.2) > 10 * small);  // beyond it
  CHECK(behind(1.4, 100, 1, 0.2) < behind(1.4, 100, 1, 0));
}

TEST_CASE("beside what leaves only noise, errors of form are as small as a diagnosis tolerates them") {
  SearchProblem problem;
  problem.least = Eigen::VectorXd::Constant(1, 9.0);
  const double tolerated = selection_criteria.tolerated_form;
  const auto negligible = [&](double mean_square) { return negligible_beside(errors_of({mean_square}), problem)[0]; };
  CHECK(negligible(1) == 9);  // the noise is not known
  problem.noise = Eigen::VectorXd::Constant(1, 1.0);
  CHECK(negligible(1) == tolerated);
  CHECK(negligible(1.3) == tolerated);
  CHECK(negligible(2) == 9);  // nothing is of quite the right form
  problem.least.setConstant(0.1);
  CHECK(negligible(1) == 0.1);
}

AttachedEffect attached(const Effect& effect, int at = 0, const std::string& place = "here") {
  return {std::make_shared<const Effect>(effect), at, -1, place, 0};
}

TEST_CASE("a further effect may mend the form of another, and is no better for that; an effect in its place is") {
  EvaluatedHypothesis one = evaluated({3}), two = evaluated({1});
  two.errors.least = Eigen::VectorXd::Constant(1, 9.0);
  two.errors.least_elsewhere = Eigen::VectorXd::Constant(1, 0.4);
  one.hypothesis.effects = {attached(effects::coulomb_friction())};
  two.hypothesis.effects = {attached(effects::coulomb_friction()), attached(effects::viscous_friction())};
  const double against_fewer = log_odds(two, one, selection_criteria);
  one.hypothesis.effects = {attached(effects::coulomb_friction()), attached(effects::quadratic_drag())};
  CHECK(log_odds(two, one, selection_criteria) > 10 * std::max(1.0, against_fewer));
  const std::vector<double> share = probabilities({one, two}, selection_criteria);
  CHECK(share[1] > 0.99);
}

TEST_CASE("a further effect elsewhere that leaves only noise counts in full, however large the first one is") {
  EvaluatedHypothesis one = evaluated({3}), two = evaluated({1});
  two.errors.least = Eigen::VectorXd::Constant(1, 9.0);
  two.errors.least_elsewhere = Eigen::VectorXd::Constant(1, 0.4);
  one.hypothesis.effects = {attached(effects::coulomb_friction())};
  two.hypothesis.effects = {attached(effects::coulomb_friction()), attached(effects::sensor_delay(), 0, "elsewhere")};
  CHECK(log_odds(two, one, selection_criteria) > 20);
}

TEST_CASE("of two with as many effects the one that leaves only noise is better by all that the other leaves") {
  EvaluatedHypothesis better = evaluated({1}), other = evaluated({1.06});
  better.errors.least = Eigen::VectorXd::Constant(1, 9.0);
  better.errors.least_elsewhere = Eigen::VectorXd::Constant(1, 0.4);
  better.hypothesis.effects = {attached(effects::coulomb_friction())};
  other.hypothesis.effects = {attached(effects::viscous_friction())};
  const double in_full = log_odds(better, other, selection_criteria);
  better.errors.least_elsewhere = better.errors.least;  // not known to be noise alone
  CHECK(in_full > log_odds(better, other, selection_criteria) + 1);
}

TEST_CASE("what acts on the same, along a coupling, or is like another effect may mend its form") {
  const auto may_mend = [](const AttachedEffect& extra, const AttachedEffect& first) {
    Hypothesis smaller, larger;
    smaller.effects = {first};
    larger.effects = {first, extra};
    return may_mend_form(larger, smaller);
  };
  const AttachedEffect friction = attached(effects::coulomb_friction(), 1, "w");
  CHECK(may_mend(attached(effects::viscous_friction(), 1, "w"), friction));
  CHECK(may_mend(attached(effects::cogging(), 1, "w"), friction));  // unlike, but at the same velocity
  CHECK_FALSE(may_mend(attached(effects::cogging(), 2, "v"), friction));
  CHECK(may_mend(attached(effects::stribeck_friction(), 2, "v"), friction));  // like it
  CHECK_FALSE(may_mend(attached(effects::sensor_delay(), 1, "w"), friction));
  CHECK(may_mend(attached(effects::viscous_friction(), 1, "w"),
                 attached(effects::cubic_stiffness_coupling(), 4, "belt")));
  CHECK_FALSE(may_mend(friction, attached(effects::constant_force(), 1, "w")));  // a constant has no form
  CHECK_FALSE(may_mend(attached(effects::sensor_drift(), 0, "y"), attached(effects::sensor_bias(), 0, "y")));
  const AttachedEffect drift = attached(effects::sensor_drift(), 0, "y");
  CHECK(may_mend(attached(effects::sensor_bias(), 0, "y"), drift));
  CHECK_FALSE(may_mend(attached(effects::quantization(), 0, "y"), drift));  // its steps show in the readings
  CHECK_FALSE(may_mend(attached(effects::sharpened(effects::quantization()), 0, "y"), drift));
}

TEST_CASE("the scale of a recording is its own in part: errors that differ from one to the next are no worse for it") {
  const ErrorSquares even = errors_of({1, 1}), uneven = errors_of({0.5, 1.5});
  const auto total = [&](const ErrorSquares& errors) {
    const auto of = log_densities(errors, even, selection_criteria);
    return std::accumulate(of.begin(), of.end(), 0.0);
  };
  CHECK(total(uneven) > total(even));  // with one scale for all only the mean over all would count
}

TEST_CASE("each recording has its own density, and what was not measured has none") {
  ErrorSquares reference = errors_of({1, 1, 1}), errors = errors_of({1, 4, 9});
  reference.counts(2, 0) = errors.counts(2, 0) = 0;
  const auto densities = log_densities(errors, reference, selection_criteria),
             best = log_densities(reference, reference, selection_criteria);
  REQUIRE(densities.size() == 3);
  CHECK(densities[0] == best[0]);
  CHECK(densities[1] < best[1]);
  CHECK(densities[2] == 0);
}

TEST_CASE("errors far below those of the integration are as good as each other") {
  const double tiny = 1e-6 * selection_criteria.least_error * selection_criteria.least_error;
  const ErrorSquares reference = errors_of({tiny});
  const double nine_times = log_densities(reference, reference, selection_criteria)[0] -
                            log_densities(errors_of({9 * tiny}), reference, selection_criteria)[0];
  CHECK(nine_times < 0.01);
}

TEST_CASE("errors of form are a share of the error without effects, by output") {
  ErrorSquares without{Eigen::MatrixXd{{4, 1}, {2, 1}}, Eigen::MatrixXd{{10, 10}, {10, 0}}, Eigen::VectorXd::Ones(2)};
  const Eigen::VectorXd least = negligible_differences(without, selection_criteria);
  REQUIRE(least.size() == 2);
  CHECK(least[0] == doctest::Approx(3 * selection_criteria.form_error * selection_criteria.form_error));
  CHECK(least[1] == doctest::Approx(selection_criteria.form_error * selection_criteria.form_error));
}

TEST_CASE("odds are those of the densities and of the priors, and the other way round they are opposite") {
  const EvaluatedHypothesis good = evaluated({1, 1, 1}), bad = evaluated({2, 2, 2}), rare = evaluated({1, 1, 1}, -5);
  CHECK(log_odds(good, bad, selection_criteria) > 10);
  CHECK(log_odds(bad, good, selection_criteria) == doctest::Approx(-log_odds(good, bad, selection_criteria)));
  CHECK(log_odds(good, rare, selection_criteria) == doctest::Approx(5));
  CHECK(log_odds(good, good, selection_criteria) == 0);
}

TEST_CASE("of two forms of one structure the closer one counts, even within what may be an error of form") {
  EvaluatedHypothesis rough = evaluated({1.1, 1.1, 1.1, 1.1}), fine = evaluated({0.9, 0.9, 0.9, 0.9}, -12);
  rough.errors.least = fine.errors.least = Eigen::VectorXd::Constant(1, 0.5);
  CHECK(log_odds(fine, rough, selection_criteria) < -10);
  CHECK(log_odds_of_forms(fine, rough, selection_criteria) > 10);
  fine.log_prior = -60;
  CHECK(log_odds_of_forms(fine, rough, selection_criteria) < 0);
}

TEST_CASE("the best one has the best of both: errors and prior") {
  CHECK(best_of({evaluated({2, 2, 2}), evaluated({1, 1, 1}, -1), evaluated({1, 1, 1}, -2)}, selection_criteria) == 1);
  CHECK(best_of({evaluated({2, 2, 2}), evaluated({1, 1, 1}, -1e4)}, selection_criteria) == 0);
  CHECK(best_of({evaluated({1})}, selection_criteria) == 0);
}

TEST_CASE("which structure is best does not depend on the order, though pairs of them may be weighed in a circle") {
  // two effects that leave 2 and 1.5 beside one that leaves 2.5: differences that may be errors of form
  std::vector<EvaluatedHypothesis> pool{evaluated({2.5, 2.5, 2.5}, 0), evaluated({2, 2, 2}, -6),
                                        evaluated({1.5, 1.5, 1.5}, -30), evaluated({1, 1, 1}, -70)};
  for (std::size_t i = 0; i < pool.size(); ++i) {
    pool[i].errors.least = Eigen::VectorXd::Constant(1, 0.2 + 0.4 * static_cast<double>(i));
  }
  std::vector<std::size_t> order{0, 1, 2, 3};
  const double best = pool[best_of(pool, selection_criteria)].log_prior;
  do {
    std::vector<EvaluatedHypothesis> other;
    for (const std::size_t i : order) other.push_back(pool[i]);
    CHECK(other[best_of(other, selection_criteria)].log_prior == best);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("probabilities add up to 1; a clearly better structure has nearly all, and two equal ones share") {
  const std::vector<double> good(8, 1.0), bad(8, 2.0);
  const auto clear = probabilities({evaluated(bad), evaluated(good), evaluated(bad)}, selection_criteria);
  CHECK(clear[1] > 0.999);
  CHECK(std::accumulate(clear.begin(), clear.end(), 0.0) == doctest::Approx(1));
  const auto equal = probabilities({evaluated(good), evaluated(bad), evaluated(good)}, selection_criteria);
  CHECK(equal[0] == doctest::Approx(0.5));
  CHECK(equal[2] == doctest::Approx(0.5));
  CHECK(probabilities({}, selection_criteria).empty());
  CHECK(probabilities({evaluated(good)}, selection_criteria).at(0) == doctest::Approx(1));
}

TEST_CASE("between equals the prior decides, by its odds") {
  const std::vector<double> same(8, 1.0);
  const auto share = probabilities({evaluated(same, std::log(3.0)), evaluated(same)}, selection_criteria);
  CHECK(share[0] == doctest::Approx(0.75));
}

TEST_CASE("what one recording alone decides stays uncertain, and what all agree on does not") {
  std::vector<double> better_in_one(8, 1.07), worse_in_one(8, 1.0);
  better_in_one[3] = 1;
  worse_in_one[3] = 2;
  const EvaluatedHypothesis one = evaluated(better_in_one), other = evaluated(worse_in_one),
                            good = evaluated(std::vector<double>(8, 1.0)),
                            bad = evaluated(std::vector<double>(8, 1.04));
  CHECK(log_odds(one, other, selection_criteria) > std::log(100));
  CHECK(log_odds(good, bad, selection_criteria) > std::log(100));
  const double alone = probabilities({one, other}, selection_criteria)[0],
               agreed = probabilities({good, bad}, selection_criteria)[0];
  CHECK(alone > 0.2);
  CHECK(alone < 0.8);
  CHECK(agreed > 0.99);
}

TEST_CASE("the same seed draws the same recordings, and more rounds change little") {
  const std::vector<EvaluatedHypothesis> two{evaluated({1, 1, 1.3, 1}), evaluated({1, 1.2, 1, 1})};
  CHECK(probabilities(two, selection_criteria) == probabilities(two, selection_criteria));
  SelectionCriteria thorough = selection_criteria, other = selection_criteria;
  thorough.rounds = 20 * selection_criteria.rounds;
  other.seed = selection_criteria.seed + 1;
  const double share = probabilities(two, thorough)[0];
  CHECK(probabilities(two, selection_criteria)[0] == doctest::Approx(share).epsilon(0.1));
  CHECK(probabilities(two, other)[0] != probabilities(two, selection_criteria)[0]);
}

AttachedEffect named_at(const std::string& name, const std::string& form, const std::string& place) {
  Effect effect;
  effect.name = name;
  effect.form = form;
  return {std::make_shared<const Effect>(effect), 0, -1, place, 0};
}

TEST_CASE("structures are the same with their effects in another order or form, but not at another place") {
  Hypothesis one, other;
  one.effects = {named_at("lag", "", "valve"), named_at("leak", "", "level")};
  other.effects = {named_at("leak", "hole", "level"), named_at("lag", "", "valve")};
  CHECK(same_structure(one, other));
  other.effects[0].place = "second level";
  CHECK_FALSE(same_structure(one, other));
  other.effects[0] = other.effects[1];
  CHECK_FALSE(same_structure(one, other));
  CHECK(same_structure({}, {}));
  CHECK_FALSE(same_structure(one, {}));
}

TEST_CASE("effects are the same in the same forms, in any order") {
  Hypothesis one, other;
  one.effects = {named_at("lag", "", "valve"), named_at("leak", "", "level")};
  other.effects = {one.effects[1], one.effects[0]};
  CHECK(same_effects(one, other));
  CHECK(is_among(one, {{}, other}));
  other.effects[0] = named_at("leak", "hole", "level");
  CHECK_FALSE(same_effects(one, other));
  CHECK_FALSE(is_among(one, {{}, other}));
  other.effects = {one.effects[0], one.effects[0]};
  CHECK_FALSE(same_effects(one, other));
}

TEST_CASE("an effect is idle if a structure without it is as close") {
  EvaluatedHypothesis small, large;
  small.hypothesis.effects = {named_at("leak", "", "level")};
  large.hypothesis.effects = {named_at("lag", "", "valve"), named_at("leak", "hole", "level")};
  const auto with_error = [](EvaluatedHypothesis one, double mean_square) {
    one.errors.mean_squares = Eigen::MatrixXd::Constant(1, 1, mean_square);
    one.errors.counts = Eigen::MatrixXd::Ones(1, 1);
    return one;
  };
  CHECK(holds_idle_effect(with_error(large, 0.99), {with_error(small, 1)}));
  CHECK(holds_idle_effect(with_error(large, 2), {with_error(small, 1)}));
  CHECK_FALSE(holds_idle_effect(with_error(large, 0.9), {with_error(small, 1)}));
  small.hypothesis.effects[0].place = "second level";  // not a part of the larger one
  CHECK_FALSE(holds_idle_effect(with_error(large, 0.99), {with_error(small, 1)}));
  CHECK_FALSE(holds_idle_effect(with_error(large, 1), {with_error(large, 1)}));
}

TEST_CASE("every parameter counts that an effect has") {
  EvaluatedHypothesis one;
  CHECK(one.parameter_count() == 0);
  for (const Effect& effect : {effects::hysteresis(), effects::not_settled(effects::first_order_lag())}) {
    one.hypothesis.effects.push_back({std::make_shared<const Effect>(effect), 0, -1, "level", 0});
    one.hypothesis.values.push_back(Eigen::VectorXd::Zero(9));  // where recordings begin counts as part of each
  }
  CHECK(one.parameter_count() == 3);
}

// A tank with effects that are told by their parameters alone.
struct PriorBench {
  EstimationSetup setup = toys::tank_setup(toys::noisy_tanks({}, 0.01));
  std::size_t candidates = 30;

  /// The prior of effects with one parameter between these multiples of its size, and this value.
  double of(const std::vector<double>& values, std::size_t known = 0, double low = -1, double high = 1,
            int memories = 0) const {
    Effect effect;
    effect.name = "wind";
    effect.place = Place::state;
    effect.parameters = {{.name = "size", .low = low, .high = high, .starts = {0.1}, .strength = true}};
    effect.hidden_states = memories;
    Hypothesis hypothesis = nominal_hypothesis(setup.bound);
    for (const double value : values) {
      hypothesis.effects.push_back({std::make_shared<const Effect>(effect), 0, -1, "level", 0});
      hypothesis.values.emplace_back(Eigen::VectorXd::Constant(1, value));
    }
    return log_prior(setup.bound, hypothesis, known, candidates, selection_criteria);
  }
};

TEST_CASE("each effect costs the choice among all candidates, and the length of its formula") {
  const PriorBench bench;
  const double choice = std::log(static_cast<double>(bench.candidates));
  CHECK(bench.of({}) == 0);
  CHECK(bench.of({0.3}) == doctest::Approx(-choice - selection_criteria.form_cost));
  CHECK(bench.of({0.3, 0.4}) == doctest::Approx(-2 * (choice + selection_criteria.form_cost)));
  CHECK(bench.of({0.3}, 0, -1, 1, 2) ==
        doctest::Approx(-choice - 2 * selection_criteria.form_cost));  // it remembers something
  CHECK(bench.of({0.3, 0.4}, 1) == doctest::Approx(bench.of({0.3})));  // one was known before
  PriorBench none;
  none.candidates = 0;
  CHECK(none.of({0.3}) == doctest::Approx(-selection_criteria.form_cost));
}

TEST_CASE("a parameter at its bound costs so much that it is never chosen") {
  const PriorBench bench;
  const double plain = bench.of({0.3}), near = selection_criteria.bound_share;
  CHECK(bench.of({1}) == doctest::Approx(plain - selection_criteria.bound_cost));
  CHECK(bench.of({-1}) == doctest::Approx(plain - selection_criteria.bound_cost));
  CHECK(bench.of({1 - near}) == doctest::Approx(plain - selection_criteria.bound_cost));
  CHECK(bench.of({1 - 3 * near}) == doctest::Approx(plain));
  CHECK(bench.of({1}, 1) == 0);
}

TEST_CASE("a strength that cannot be negative may be small, but not at its upper bound") {
  const PriorBench bench;
  const double plain = bench.of({0.3}, 0, 0);
  CHECK(bench.of({0.0}, 0, 0) == doctest::Approx(plain));
  CHECK(bench.of({1.0}, 0, 0) == doctest::Approx(plain - selection_criteria.bound_cost));
}

TEST_CASE("an effect of which a second strength does nothing is left to the simpler one") {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks({}, 0.01));
  const auto prior = [&](double first, double second) {
    Effect effect;
    effect.name = "wind";
    effect.place = Place::state;
    effect.parameters = {{.name = "mean", .low = 0, .high = 1, .starts = {0.1}, .strength = true},
                         {.name = "gusts", .low = 0, .high = 1, .starts = {0.1}, .strength = true}};
    Hypothesis hypothesis = nominal_hypothesis(setup.bound);
    hypothesis.effects.push_back({std::make_shared<const Effect>(effect), 0, -1, "level", 0});
    hypothesis.values.emplace_back(Eigen::Vector2d(first, second));
    return log_prior(setup.bound, hypothesis, 0, 30, selection_criteria);
  };
  CHECK(prior(0.3, 0) == doctest::Approx(prior(0.3, 0.01) - selection_criteria.bound_cost));
  CHECK(prior(0, 0.3) == doctest::Approx(prior(0.3, 0.3)));
}

TEST_CASE("a fit is evaluated on all its recordings, with what its parameters cost") {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks(toys::extra_inflow(), 0.01));
  SearchProblem problem;
  problem.fit = setup.problem;
  problem.scale.sigma = Eigen::VectorXd::Constant(1, 0.01);
  problem.least = Eigen::VectorXd::Constant(1, 0.25);
  problem.candidates = 10;
  const auto measured = [&](const std::vector<NamedEffect>& effects) {
    const Fit fitted = fit(setup.bound, toys::with_effects(setup, effects), problem.fit, serially());
    const EvaluatedHypothesis one = evaluate_fit(setup.bound, fitted, problem, serially());
    CHECK(one.loss == fitted.loss);
    CHECK(one.errors.mean_squares.rows() == 4);
    CHECK(one.errors.least == problem.least);
    const Hypothesis& hypothesis = fitted.hypothesis;
    CHECK(one.log_prior ==
          doctest::Approx(log_prior(setup.bound, hypothesis, 0, problem.candidates, selection_criteria) +
                          log_occam_factor(setup.bound, hypothesis, problem.fit, least_variance(problem), serially())));
    return one;
  };
  const EvaluatedHypothesis without = measured({}), with = measured(toys::extra_inflow());
  CHECK(with.errors.rms() == doctest::Approx(1).epsilon(0.1));  // in units of the noise
  CHECK(with.log_prior < without.log_prior - std::log(10));
  CHECK(log_odds(with, without, selection_criteria) > std::log(selection_criteria.named_odds));
}

}  // namespace
}  // namespace surefoot::diagnosis

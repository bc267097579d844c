// A structure with a further effect.
#include "surefoot/diagnose/selection/extend.hpp"

#include <doctest/doctest.h>

#include <memory>
#include <vector>

#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("the pool keeps the better of two forms of a structure") {
  const TankBench bench({});
  EvaluatedHypothesis good = bench.with({"constant_rate"}), bad = good;
  bad.errors.mean_squares *= 9;
  const SelectionCriteria& criteria = bench.problem.criteria;
  std::vector<EvaluatedHypothesis> pool{bench.with({})};
  CHECK(keep_best_form(pool, bad, criteria));
  CHECK(keep_best_form(pool, good, criteria));
  CHECK_FALSE(keep_best_form(pool, bad, criteria));
  CHECK_FALSE(keep_best_form(pool, good, criteria));
  REQUIRE(pool.size() == 2);
  CHECK(pool[1].errors.rms() == good.errors.rms());
}

TEST_CASE("a form with fewer parameters that leaves no more is kept, whatever the odds") {
  const TankBench bench({});
  EvaluatedHypothesis plain = bench.with({"constant_rate"}), vague = plain;
  Effect longer = *vague.hypothesis.effects[0].effect;
  longer.parameters.push_back(longer.parameters[0]);
  vague.hypothesis.effects[0].effect = std::make_shared<const Effect>(longer);
  vague.hypothesis.values[0] = Eigen::VectorXd::Ones(2);
  vague.log_prior += 100;
  REQUIRE(vague.parameter_count() > plain.parameter_count());
  const SelectionCriteria& criteria = bench.problem.criteria;
  std::vector<EvaluatedHypothesis> pool{plain};
  CHECK_FALSE(keep_best_form(pool, vague, criteria));
  pool = {vague};
  CHECK(keep_best_form(pool, plain, criteria));
  vague.errors.mean_squares *= 0.9;  // it leaves less: the odds decide
  CHECK(keep_best_form(pool, vague, criteria));
}

TEST_CASE("weights follow what the best structure leaves, but no further than errors of the integration") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  search.problem.screened = {0, 1};
  const EvaluatedHypothesis none = bench.with({}), best = bench.with({"constant_rate"});
  reweight(search, none);
  const double before = search.problem.fit.weighting.sigma[0];
  CHECK(before == doctest::Approx(none.errors.rms() * search.problem.scale.sigma[0]).epsilon(0.1));
  reweight(search, best);
  CHECK(search.problem.fit.weighting.sigma[0] == doctest::Approx(0.01).epsilon(0.1));
  CHECK(search.problem.screened.size() == 2);
  CHECK(search.problem.fit.weighting.scale.size() == 6);
  search.problem.criteria.least_error = 10;
  reweight(search, best);
  CHECK(search.problem.fit.weighting.sigma[0] == doctest::Approx(10 * search.problem.scale.sigma[0]));
}

TEST_CASE("what effects explain is integrated more finely, never more coarsely") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  const EvaluatedHypothesis best = bench.with({"constant_rate"});
  Integration& now = search.problem.fit.integration;
  now = {.order = 2, .step = 0.07};  // rows are 0.05 s long, and the coarsest steps one and a half of them
  search.problem.fit.weighting.sigma[0] = 1;
  CHECK_FALSE(refine_integration(search, best));
  search.problem.fit.weighting.sigma[0] = 1e-6;
  CHECK(refine_integration(search, best));
  CHECK((now.order == 4 || now.step < 0.07));
  REQUIRE(search.problem.screening.has_value());
  const Integration fine = now, screening = screening_fit(search.problem, 4).integration;
  CHECK_FALSE(is_finer(screening, fine));
  search.problem.fit.weighting.sigma[0] = 1;
  CHECK_FALSE(refine_integration(search, best));
  CHECK(now.order == fine.order);
  CHECK(now.step == fine.step);
  CHECK(is_finer(screening, screening_fit(search.problem, 4).integration));
  search.problem.fit.weighting.sigma[0] = 1e-6;
  Hypothesis far = best.hypothesis;
  far.values[0][0] = 0.1;  // half of it
  choose_screening(search, evaluate_fit(bench.bound, Fit{far, 0, true}, bench.problem, bench.parallel));
  CHECK(is_finer(fine, screening_fit(search.problem, 4).integration));  // by what is left, whatever the weights
}

TEST_CASE("the best structures are fitted again, always with the model without effects, and none gets worse") {
  const TankBench bench({rate_in_tank});
  const SelectionCriteria& criteria = bench.problem.criteria;
  Hypothesis far = bench.start({"constant_rate"});
  far.values[0][0] = 0.19;
  const Fit unfinished{far, 0, true};
  std::vector<EvaluatedHypothesis> pool{bench.with({}),
                                        evaluate_fit(bench.bound, unfinished, bench.problem, bench.parallel)};
  const auto again = fitted_again(bench.search(), pool);
  REQUIRE(again.size() == 2);
  CHECK(again[0].hypothesis.values[0][0] == doctest::Approx(0.2).epsilon(0.1));
  CHECK(names_in(again[1]).empty());
  refit_best(bench.search(), pool);
  REQUIRE(pool.size() == 2);
  CHECK(pool[1].errors.rms() == again[0].errors.rms());
  CHECK(log_odds(pool[1], pool[0], criteria) > 0);
  Search stopped = bench.search();
  stopped.problem.stopped = [] { return true; };
  std::vector<EvaluatedHypothesis> same{bench.with({})};
  same[0].loss = 7;
  refit_best(stopped, same);
  CHECK(same[0].loss == 7);
}

TEST_CASE("other places are tried where the best structure leaves more than noise, of which there may be none") {
  const TankBench bench({rate_in_tank});
  std::vector<EvaluatedHypothesis> none;
  try_around(bench.search(), none);
  CHECK(none.empty());
  Hypothesis lost = bench.start({"constant_rate"});
  lost.parameters[0] = bench.bound.info.parameters[0].high;
  const EvaluatedHypothesis far = evaluate_fit(bench.bound, Fit{lost, 0, true}, bench.problem, bench.parallel);
  int fits = 0;
  const auto tried = [&](bool structured) {
    Search search = bench.search();
    search.problem.structured = [structured](const Hypothesis&, const FitProblem&) { return structured; };
    search.problem.fit.stopped = [&fits] { return ++fits < 0; };
    std::vector<EvaluatedHypothesis> pool{far};
    fits = 0;
    try_around(search, pool);
    return fits > 0;
  };
  CHECK(tried(true));
  CHECK_FALSE(tried(false));
}

TEST_CASE("a first effect is settled with the inputs and steps that it needs before it is given a second one") {
  TankBench bench({rate_in_tank});
  bench.read_with_straight_inputs({rate_in_tank});
  Search search = bench.search();
  search.problem.structured = [](const Hypothesis&, const FitProblem& fit) {
    return fit.integration.inputs.empty() || fit.integration.inputs[0] != InputHold::linear;
  };
  const std::vector<EvaluatedHypothesis> held{bench.with({"constant_rate"}), bench.with({"sensor_drift"})};
  std::vector<EvaluatedHypothesis> children = held;
  REQUIRE(settle_alone(search, children));
  CHECK(search.problem.fit.integration.inputs[0] == InputHold::linear);
  const EvaluatedHypothesis& best = children[best_of(children, bench.problem.criteria)];
  CHECK(names_in(best) == "constant_rate");
  CHECK(best.errors.rms() < 0.9 * held[0].errors.rms());

  Search more = bench.search();
  more.problem.structured = [](const Hypothesis&, const FitProblem&) { return true; };
  children = held;
  CHECK_FALSE(settle_alone(more, children));
  CHECK(more.problem.fit.integration.inputs.empty());
  CHECK(children[0].errors.rms() == held[0].errors.rms());
  std::vector<EvaluatedHypothesis> none;
  CHECK_FALSE(settle_alone(search, none));
}

TEST_CASE("first effects are fitted from many parameters where the calibrated ones are a trap, others are left alone") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  search.problem.fit.max_iterations = 3;  // too few to find back
  Hypothesis trapped = bench.start({"constant_rate"}), two = bench.start({"constant_rate", "sensor_drift"});
  for (Hypothesis* one : {&trapped, &two}) {
    const auto variables = variables_of(bench.bound, *one, {});
    value_of(*one, variables.front()) = variables.front().high;
  }
  const auto as_it_is = [&](const Hypothesis& one) {
    return evaluate_fit(bench.bound, {one, 1e9, true}, search.problem, serially());
  };
  std::vector<EvaluatedHypothesis> children{as_it_is(trapped), as_it_is(two)};
  const double before = children[0].errors.rms(), of_two = children[1].errors.rms();
  fit_from_everywhere(search, children);
  CHECK(children[0].errors.rms() < 0.2 * before);
  CHECK(children[1].errors.rms() == of_two);
}

}  // namespace
}  // namespace surefoot::diagnosis

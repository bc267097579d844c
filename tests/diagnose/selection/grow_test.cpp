// How the pool of structures grows.
#include "surefoot/diagnose/selection/grow.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "surefoot/diagnose/effects/constant_force.hpp"
#include "surefoot/diagnose/effects/quadratic_drag.hpp"
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
  const Integration fine = now;
  search.problem.fit.weighting.sigma[0] = 1;
  CHECK_FALSE(refine_integration(search, best));
  CHECK(now.order == fine.order);
  CHECK(now.step == fine.step);
}

TEST_CASE("the search begins a second time from the nominal parameters, with their weights, and keeps its own") {
  TankBench bench({rate_in_tank});
  Search search = bench.search();
  search.problem.fit.weighting.sigma[0] = 0.001;
  const auto children = extended_from(search, bench.problem.nominal, nullptr);
  REQUIRE_FALSE(children.empty());
  const EvaluatedHypothesis& best = children[best_of(children, bench.problem.criteria)];
  CHECK(names_in(best) == "constant_rate");
  CHECK(best.loss < 1);  // in units of what the nominal parameters leave
  CHECK(search.problem.fit.weighting.sigma[0] == 0.001);
  search.problem.stopped = [] { return true; };
  CHECK(extended_from(search, bench.problem.nominal, nullptr).empty());
}

TEST_CASE("a pool grows as long as a further effect makes the best structure better") {
  const TankBench bench({rate_in_tank, drift_in_tank}), nothing({});
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({})};
  std::vector<std::string> stages;
  search.problem.on_progress = [&](const std::string& stage, double share) {
    stages.push_back(stage);
    CHECK(share >= 0);
    CHECK(share < 1);
  };
  std::vector<Hypothesis> done;
  grow(search, pool, done);
  CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]) == "constant_rate, sensor_drift");
  CHECK(done.size() > 1);
  CHECK_FALSE(stages.empty());
  CHECK(search.problem.fit.weighting.sigma[0] == doctest::Approx(0.01).epsilon(0.1));

  Search idle = nothing.search();
  idle.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  std::vector<EvaluatedHypothesis> clean{nothing.with({})};
  int rounds = 0;
  idle.problem.on_progress = [&](const std::string&, double) { ++rounds; };
  std::vector<Hypothesis> idle_done;
  grow(idle, clean, idle_done);
  CHECK(rounds == 1);
  CHECK(names_in(clean[best_of(clean, nothing.problem.criteria)]).empty());
}

TEST_CASE("a first effect whose fit ended in a valley is tried from places around before others mend it") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  search.problem.structured = [](const Hypothesis& one, const FitProblem&) {
    return one.effects.size() != 1 || std::abs(one.values[0][0] - 0.2) > 0.02;
  };
  const Fit unfinished{bench.start({"constant_rate"}), 0, true};
  std::vector<EvaluatedHypothesis> children{evaluate_fit(bench.bound, unfinished, bench.problem, bench.parallel)};
  begin_elsewhere(search, children);
  REQUIRE(children.size() == 1);
  CHECK(children[0].hypothesis.values[0][0] == doctest::Approx(0.2).epsilon(0.1));
}

TEST_CASE("where residuals hold structure one step that does not pay is followed by another, but two only if nearer") {
  const auto rounds_with = [](const TankBench& bench) {
    const Search start = bench.search();
    Search search = start;
    int rounds = 0;
    search.problem.on_progress = [&](const std::string&, double) { ++rounds; };
    std::vector<EvaluatedHypothesis> pool{bench.with({})};
    std::vector<Hypothesis> done;
    grow(search, pool, done);
    CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]).empty());
    return rounds;
  };
  TankBench one({rate_in_tank}), two({rate_in_tank, {"sensor_drift", "level_m", {}, {}, {0.3}}});
  for (TankBench* bench : {&one, &two}) {
    bench->problem.criteria.form_cost = 1e4;  // no effect pays
    bench->problem.effort.hopeless = 1e6;
    bench->problem.effort.pairs = bench->problem.effort.combined = 0;  // one effect after the other
  }
  CHECK(rounds_with(one) == 2);
  CHECK(rounds_with(two) == 3);                                    // its second step comes much nearer
  one.problem.effort.hopeless = two.problem.effort.hopeless = 15;  // beyond which is followed only what does so
  CHECK(rounds_with(one) == 2);
  CHECK(rounds_with(two) == 3);
  two.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  CHECK(rounds_with(two) == 1);
}

TEST_CASE("a first effect that leaves only noise needs no other start") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> children{bench.with({"constant_rate"})};
  search.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  begin_elsewhere(search, children);
  CHECK(children.size() == 1);
  search.problem.structured = [](const Hypothesis&, const FitProblem&) { return true; };
  begin_elsewhere(search, children);
  CHECK(children.size() > 1);
}

TEST_CASE("what stands at a bound is fitted again from inside, unless it would be worse in any case") {
  const TankBench bench({rate_in_tank});
  const Search search = bench.search();
  const EvaluatedHypothesis none = bench.with({});
  const auto at_bound = [&](const char* name) {
    Fit there{bench.start({name}), 0, true};
    const auto variables = variables_of(bench.bound, there.hypothesis, {});
    const auto own = std::find_if(variables.begin(), variables.end(),
                                  [](const Variable& one) { return one.kind == Variable::Kind::effect; });
    there.hypothesis.values[0][0] = own->high;
    return there;
  };
  Fit rate = at_bound("constant_rate");
  EvaluatedHypothesis stuck = evaluate_fit(bench.bound, rate, search.problem, serially());
  stuck.errors = none.errors;  // as near as without it, but for the bound
  REQUIRE(log_odds(stuck, none, search.problem.criteria) < -20);
  EvaluatedHypothesis far = stuck;
  far.errors.mean_squares *= 1e3;
  std::vector<EvaluatedHypothesis> children{stuck, far};
  draw_inside(search, none, children);
  CHECK(children[0].hypothesis.values[0][0] == doctest::Approx(0.2).epsilon(0.05));
  CHECK(log_odds(children[0], none, search.problem.criteria) > 20);
  CHECK(children[1].hypothesis.values[0][0] == stuck.hypothesis.values[0][0]);
}

TEST_CASE("what was extended before is not extended again") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({"constant_rate"})};
  std::vector<Hypothesis> done{pool.front().hypothesis};
  grow(search, pool, done);
  CHECK(pool.size() == 1);
  done.clear();
  grow(search, pool, done);
  CHECK(pool.size() > 1);
}

TEST_CASE("a search yields to another explanation that does better than its first effects") {
  TankBench bench({rate_in_tank});
  CHECK_FALSE(bench.found().yields);
  bench.problem.rival = 1e9;
  const Selection selection = bench.found();
  CHECK(selection.yields);
  CHECK(selection.chosen.hypothesis.effects.size() <= 1);
}

TEST_CASE("no structure has more effects than are allowed") {
  TankBench bench({rate_in_tank, drift_in_tank});
  bench.problem.criteria.max_effects = 1;
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({})};
  std::vector<Hypothesis> done;
  grow(search, pool, done);
  for (const EvaluatedHypothesis& one : pool) CHECK(one.hypothesis.effects.size() <= 1);
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

TEST_CASE("what comes nearest is extended without what it holds idle as well") {
  const TankBench bench({rate_in_tank});
  const Search search = bench.search();
  std::vector<EvaluatedHypothesis> beam;
  add_with_smaller(search, bench.with({"constant_rate", "sensor_drift"}), beam);
  REQUIRE(beam.size() == 2);
  CHECK(names_in(beam[0]) == "constant_rate, sensor_drift");
  CHECK(names_in(beam[1]) == "constant_rate");
}

TEST_CASE("what does not pay beside the model without effects does not pay") {
  const TankBench sloped({rate_in_tank}), nothing({});
  const std::vector<EvaluatedHypothesis> pool{sloped.with({})}, clean{nothing.with({})};
  CHECK(pays(sloped.search(), sloped.with({"constant_rate"}), pool));
  CHECK_FALSE(pays(sloped.search(), pool[0], pool));
  CHECK_FALSE(pays(nothing.search(), nothing.with({"constant_rate"}), clean));
}

/// A pendulum let go, without any loss.
struct LooseSwing {
  using State = Vec<2>;
  using Input = Vec<0>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "loose swing",
            .states = {{"angle", "rad"}, {"speed", "rad/s"}},
            .inputs = {},
            .outputs = {{"angle_rad", "rad"}},
            .parameters = {{"gravity", "1/s^2", 64, 20, 150}, {"zero", "rad", 0, -0.1, 0.1}}};
  }
  State derivative(const State& x, const Input& /*u*/, const Eigen::VectorXd& p) const {
    return {x[1], -p[0] * std::sin(x[0] + p[1])};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};

TEST_CASE("under guidance first effects are found along the readings, wherever the model has run to") {
  std::vector<Recording> recordings;
  Rng rng(8);
  for (int r = 0; r < 4; ++r) {
    Recording one = toys::blank_recording(LooseSwing{}.info(), 1200, 0.01);
    one.initial[0] = 1.7 - 0.3 * r;
    const auto machine = toys::machine({64, 0}, {{"quadratic_drag", "speed", {}, {}, {0.03}}}, {.step = 0.002});
    one.outputs = simulate_augmented(LooseSwing{}, machine, one).outputs;
    for (double& angle : one.outputs.reshaped()) angle += 0.002 * rng.normal();
    recordings.push_back(std::move(one));
  }
  BoundSimulator bound = bind_simulator(LooseSwing{}, std::move(recordings));
  SearchProblem problem;
  problem.fit.recordings = problem.screened = {0, 1, 2, 3};
  problem.scale.sigma = error_scale(bound);
  for (const double gravity : {32.0, 120.0}) {
    CAPTURE(gravity);
    problem.nominal = nominal_hypothesis(bound);
    problem.nominal.parameters[0] = gravity;
    problem.fit.weighting.sigma = Eigen::VectorXd::Constant(1, 1);
    const Parallel parallel = serially();
    const Fit trapped = fit(bound, problem.nominal, problem.fit, parallel);
    const auto runs = simulate_all(bound, trapped.hypothesis, problem.fit.recordings, {}, parallel);
    bound.sizes = measure_sizes(bound, trapped.hypothesis, problem.fit.recordings, runs);
    const auto candidates = attachments(bound, {effects::quadratic_drag(), effects::constant_force()}, {});
    problem.candidates = candidates.size();
    const auto children = extended_under_guidance({bound, problem, candidates, parallel});
    REQUIRE_FALSE(children.empty());
    const EvaluatedHypothesis& best = children[best_of(children, problem.criteria)];
    CHECK(names_in(best) == "quadratic_drag");
    CHECK(best.hypothesis.parameters[0] == doctest::Approx(64).epsilon(0.01));
    CHECK(best.hypothesis.values[0][0] / 0.03 == doctest::Approx(1).epsilon(0.05));
    CHECK(trapped.loss > 100 * best.loss);
  }
  bound.structure.output_of = {-1, -1};
  CHECK(extended_under_guidance({bound, problem, {}, serially()}).empty());
}

}  // namespace
}  // namespace surefoot::diagnosis

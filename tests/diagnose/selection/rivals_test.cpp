// What may stand in the place of effects of the best structure.
#include "surefoot/diagnose/selection/rivals.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "surefoot/diagnose/effects/cogging.hpp"
#include "surefoot/diagnose/effects/gravity_offset.hpp"
#include "surefoot/diagnose/effects/quantization.hpp"
#include "surefoot/diagnose/selection/extend.hpp"
#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("from the parameters of two effects that stand in for one, that one is found") {
  const TankBench bench({rate_in_tank});
  const SelectionCriteria& criteria = bench.problem.criteria;
  const Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"sensor_drift", "sensor_bias"})};
  REQUIRE(search.effects(pool[best_of(pool, criteria)]) == 2);
  begin_anew(search, pool);
  CHECK(names_in(pool[best_of(pool, criteria)]) == "constant_rate");

  std::vector<EvaluatedHypothesis> single{bench.with({}), bench.with({"sensor_drift"})};
  begin_anew(search, single);
  CHECK(single.size() == 2);  // the search began with single effects
}

TEST_CASE("what drove a parameter to its bound is extended from the nominal parameters") {
  TankBench bench({rate_in_tank, drift_in_tank});
  bench.problem.noise.setConstant(1, std::pow(0.01 / bench.problem.scale.sigma[0], 2));  // mean squares
  const SelectionCriteria& criteria = bench.problem.criteria;
  const Search search = bench.search();
  EvaluatedHypothesis driven = bench.with({"sensor_drift"});
  std::vector<EvaluatedHypothesis> pool{bench.with({}), driven};
  extend_from_nominal(search, pool);
  CHECK(pool.size() == 2);  // no parameter is at a bound

  driven.hypothesis.parameters[0] = bench.bound.info.parameters[0].low;
  pool[1] = driven;  // with the errors of its fit, so that it stays the best so far
  extend_from_nominal(search, pool);
  CHECK(names_in(pool[best_of(pool, criteria)]) == "constant_rate, sensor_drift");
}

TEST_CASE("effects of the best structure are taken away and replaced in turn") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const SelectionCriteria& criteria = bench.problem.criteria;
  std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"sensor_drift", "sensor_bias"})};
  std::vector<Hypothesis> done;
  swap_effects(bench.search(), pool, done);
  CHECK(names_in(pool[best_of(pool, criteria)]) == "constant_rate, sensor_drift");
  const auto has = [&](const std::string& names) {
    return std::ranges::any_of(pool, [&](const EvaluatedHypothesis& one) { return names_in(one) == names; });
  };
  CHECK(has("sensor_drift"));
  CHECK(has("sensor_bias"));
}

TEST_CASE("effects of other structures stand in the place of those of the best one, as they were found") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const SelectionCriteria& criteria = bench.problem.criteria;
  std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"sensor_drift", "sensor_bias"}),
                                        bench.with({"constant_rate"})};
  exchange_effects(bench.search(), pool);
  CHECK(names_in(pool[best_of(pool, criteria)]) == "constant_rate, sensor_drift");

  std::vector<EvaluatedHypothesis> alone{bench.with({}), bench.with({"sensor_drift"}), bench.with({"sensor_bias"})};
  exchange_effects(bench.search(), alone);
  CHECK(alone.size() == 3);  // of single effects all were tried
}

TEST_CASE("what is left of the best structure is extended once") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const SelectionCriteria& criteria = bench.problem.criteria;
  const std::vector<EvaluatedHypothesis> before{bench.with({}), bench.with({"sensor_drift", "sensor_bias"})};
  std::vector<EvaluatedHypothesis> pool = before;
  std::vector<Hypothesis> done;
  swap_effects(bench.search(), pool, done);
  CHECK(done.size() == 2);  // each of the two alone
  pool = before;
  swap_effects(bench.search(), pool, done);
  CHECK(done.size() == 2);
  CHECK(names_in(pool[best_of(pool, criteria)]) == names_in(before[1]));
}

TEST_CASE("a rival must promise what makes it as probable, but no more than the effect in its place does") {
  const TankBench bench({rate_in_tank});
  const Search search = bench.search();
  const EvaluatedHypothesis best = bench.with({"constant_rate"}), rest = bench.with({});
  std::vector<Proposal> proposals = proposals_for(search, rest);
  const double needed = needed_gain(search, rest, best, 1);
  CHECK(needed_instead(search, rest, best, 0, proposals) == std::min(needed, proposals.at(0).gain));
  proposals[0].gain = 0.01;  // as of friction that holds a machine, which no linear prediction sees
  CHECK(needed_instead(search, rest, best, 0, proposals) == 0.01);
  CHECK(needed_instead(search, rest, best, 0, {}) == 0);
}

TEST_CASE("what an effect may be confused with is tried in its place, beside the parameters found with it") {
  const TankBench bench({rate_in_tank});
  const SelectionCriteria& criteria = bench.problem.criteria;
  std::vector<EvaluatedHypothesis> pool{bench.with({"sensor_drift"})};
  REQUIRE(names_in(pool[best_of(pool, criteria)]) == "sensor_drift");
  Search search = bench.search();
  try_confusable(search, pool);
  CHECK(names_in(pool[best_of(pool, criteria)]) == "constant_rate");
  for (const EvaluatedHypothesis& one : pool) CHECK(one.hypothesis.effects.size() <= 1);  // in its place, not beside it

  Search stopped = bench.search();
  stopped.problem.stopped = [] { return true; };
  std::vector<EvaluatedHypothesis> same{bench.with({"sensor_drift"})};
  try_confusable(stopped, same);
  CHECK(same.size() == 1);
}

TEST_CASE("an effect that only mends the form of another goes when that has its own form") {
  constexpr double step = 0.1;
  TankBench bench({{"quantization", "level_m", "floor", {}, {step}}});
  bench.candidates =
      attachments(bench.bound, {effects::sensor_bias(), effects::quantization(), effects::quantization_floor()},
                  std::vector<bool>(2, true));
  Hypothesis mended = bench.start({"sensor_bias", "quantization"});
  mended.values[0][0] = -step / 2;
  mended.values[1][0] = step;
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> pool{bench.with({}), bench.with({"sensor_bias"}), refitted(search, mended)};
  REQUIRE(names_in(pool[best_of(pool, bench.problem.criteria)]) == "quantization, sensor_bias");
  try_confusable(search, pool);
  const EvaluatedHypothesis& best = pool[best_of(pool, bench.problem.criteria)];
  CHECK(names_in(best) == "quantization");
  CHECK(best.hypothesis.effects.at(0).effect->form == "floor");
}

TEST_CASE("a rival is weighed with the steps that it needs, and all go on with these only if it is better then") {
  const TankBench bench({rate_in_tank});
  const EvaluatedHypothesis rate = bench.with({"constant_rate"}), drift = bench.with({"sensor_drift"});
  const auto coarse = [&](double residual) {
    Search search = bench.search();
    search.problem.fit.integration = {.order = 2, .step = 0.07};  // rows are 0.05 s long
    search.problem.fit.weighting.sigma[0] = residual;
    return search;
  };
  const auto is_finer = [](const Search& search) {
    const Integration& now = search.problem.fit.integration;
    return now.order > 2 || now.step < 0.07;
  };
  std::vector<EvaluatedHypothesis> pool{drift};
  Search fine = coarse(1e-6), enough = coarse(1), worse = coarse(1e-6);
  weigh_with_its_own_steps(fine, rate, drift, pool);
  CHECK(is_finer(fine));
  CHECK(names_in(pool[best_of(pool, bench.problem.criteria)]) == "constant_rate");
  pool = {drift};
  weigh_with_its_own_steps(enough, rate, drift, pool);
  CHECK_FALSE(is_finer(enough));
  CHECK(pool.size() == 1);
  pool = {rate};
  weigh_with_its_own_steps(worse, drift, rate, pool);
  CHECK_FALSE(is_finer(worse));
  CHECK(pool.size() == 1);
}

/// A counterweighted arm that a motor swings far around where it rests.
struct CounterweightedArm {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "arm",
            .states = {{"angle", "rad"}, {"speed", "rad/s", "N m"}},
            .inputs = {{"torque", "N m"}},
            .outputs = {{"angle_rad", "rad"}},
            .parameters = {{"weight", "N m", 0.85, 0.1, 4}, {"damping", "N m s", 0.12, 0, 2}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], (u[0] - p[1] * x[1] - p[0] * std::sin(x[0])) / inertia};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
  State effort(const State& /*x*/, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return {1, inertia}; }

  static constexpr double inertia = 0.048;  // [kg m^2]
};

TEST_CASE("what stands in an effect's place is fitted under guidance where it is lost without that effect") {
  const NamedEffect offset{"gravity_offset", "speed", {}, {}, {0.21}};
  std::vector<Recording> recordings;
  Rng rng(4);
  for (int r = 0; r < 4; ++r) {
    Recording one = toys::blank_recording(CounterweightedArm{}.info(), 500, 0.02);
    for (Eigen::Index i = 0; i < one.rows(); ++i) {
      one.inputs(0, i) = (0.7 + 0.1 * r) * std::sin((1 + 0.7 * r) * one.time[i]);
    }
    one.outputs = simulate_augmented(CounterweightedArm{}, toys::machine({0.95, 0.11}, {offset}), one).outputs;
    for (double& angle : one.outputs.reshaped()) angle += 0.001 * rng.normal();
    recordings.push_back(std::move(one));
  }
  BoundSimulator bound = bind_simulator(CounterweightedArm{}, std::move(recordings));
  SearchProblem problem;
  problem.fit.recordings = problem.screened = {0, 1, 2, 3};
  problem.fit.weighting.sigma.setConstant(1, 0.001);
  problem.scale.sigma = error_scale(bound);
  problem.nominal = nominal_hypothesis(bound);
  const Parallel parallel = serially();
  bound.sizes = measure_sizes(bound, problem.nominal, problem.fit.recordings,
                              simulate_all(bound, problem.nominal, problem.fit.recordings, {}, parallel));
  const std::vector<AttachedEffect> candidates =
      attachments(bound, {effects::cogging_per_turn(), effects::gravity_offset()}, std::vector<bool>(2, true));
  problem.candidates = candidates.size();
  problem.noise.setConstant(1, std::pow(0.001 / problem.scale.sigma[0], 2));  // mean squares
  Search search{bound, problem, candidates, parallel};
  const auto fitted_with = [&](const AttachedEffect& effect, const std::vector<double>& values) {
    Hypothesis start = problem.nominal;
    start.parameters << 1.1, 0.11;
    start.effects = {effect};
    start.values = {Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()))};
    return evaluate_fit(bound, fit(bound, start, problem.fit, parallel), problem, parallel);
  };
  std::vector<EvaluatedHypothesis> pool{
      evaluate_fit(bound, fit(bound, problem.nominal, problem.fit, parallel), problem, parallel),
      fitted_with(candidates[0], {0.15, 0.21, 1})};
  REQUIRE(names_in(pool[best_of(pool, problem.criteria)]) == "cogging");
  try_confusable(search, pool);
  CHECK(names_in(pool[best_of(pool, problem.criteria)]) == "gravity_offset");
}

}  // namespace
}  // namespace surefoot::diagnosis

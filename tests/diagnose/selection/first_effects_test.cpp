// First effects of a model without any, wherever its calibrated parameters ended.
#include "surefoot/diagnose/selection/first_effects.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "surefoot/diagnose/effects/constant_force.hpp"
#include "surefoot/diagnose/effects/quadratic_drag.hpp"
#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

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

TEST_CASE("a first effect whose fit ended in a valley is tried from places around before others mend it") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  search.problem.structured = [](const Hypothesis& one, const FitProblem&) {
    return one.effects.size() != 1 || std::abs(one.values[0][0] - 0.2) > 0.02;
  };
  const Fit unfinished{bench.start({"constant_rate"}), 0, true};
  std::vector<EvaluatedHypothesis> children{evaluate_fit(bench.bound, unfinished, bench.problem, bench.parallel)};
  begin_elsewhere(search, false, children);
  REQUIRE(children.size() == 1);
  CHECK(children[0].hypothesis.values[0][0] == doctest::Approx(0.2).epsilon(0.1));
}

TEST_CASE("first effects that a rival explanation beats are not sought from elsewhere") {
  const TankBench bench({drift_in_tank});
  Search search = bench.search();
  int asked = 0;  // whether something explains the recordings
  search.problem.structured = [&asked](const Hypothesis&, const FitProblem&) { return ++asked > 0; };
  first_effects(search, bench.with({}));
  const int everywhere = std::exchange(asked, 0);
  search.problem.rival = 1e9;
  CHECK_FALSE(first_effects(search, bench.with({})).empty());
  CHECK(asked < 0.7 * everywhere);
}

TEST_CASE("a first effect that leaves only noise needs no other start") {
  const TankBench bench({rate_in_tank});
  Search search = bench.search();
  std::vector<EvaluatedHypothesis> children{bench.with({"constant_rate"})};
  search.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  begin_elsewhere(search, false, children);
  CHECK(children.size() == 1);
  search.problem.structured = [](const Hypothesis&, const FitProblem&) { return true; };
  begin_elsewhere(search, false, children);
  CHECK(children.size() > 1);
}

TEST_CASE("the search goes on with the integration that a first effect was fitted with, where it is lost in its own") {
  for (const double noise : {0.01, 1e-4}) {
    TankBench bench({rate_in_tank});
    bench.read_with_straight_inputs({rate_in_tank}, noise);
    Search search = bench.search();
    search.problem.structured = [](const Hypothesis& one, const FitProblem& fit) {
      const std::vector<InputHold>& inputs = fit.integration.inputs;
      return one.effects.size() != 1 || inputs.empty() || inputs[0] != InputHold::linear;
    };
    std::vector<EvaluatedHypothesis> children{bench.with({"sensor_bias"})};
    begin_elsewhere(search, false, children);
    const bool lost = noise < 0.01;
    CHECK((search.problem.fit.integration.inputs == std::vector{InputHold::linear}) == lost);
  }
}

TEST_CASE("where the model has lost the readings, first effects are sought along them first") {
  const TankBench bench({rate_in_tank});
  EvaluatedHypothesis none = bench.with({});
  none.errors.mean_squares.setConstant(0.2 * 0.2);
  CHECK_FALSE(has_lost_readings(none));
  none.errors.mean_squares.setConstant(0.4 * 0.4);
  CHECK(has_lost_readings(none));
  Search search = bench.search();
  search.problem.structured = [](const Hypothesis& one, const FitProblem&) { return one.effects.empty(); };
  std::size_t rounds = 0;
  search.problem.stopped = [&] { return ++rounds > 1000000; };
  const auto along = first_effects(search, none);
  const std::size_t needed = rounds;
  REQUIRE_FALSE(along.empty());
  CHECK(names_in(along[best_of(along, bench.problem.criteria)]) == "constant_rate");
  rounds = 0;
  search.problem.structured = [](const Hypothesis&, const FitProblem&) { return true; };
  const auto everywhere = first_effects(search, none);  // and from everywhere else, where that leaves more than noise
  CHECK(names_in(everywhere[best_of(everywhere, bench.problem.criteria)]) == "constant_rate");
  CHECK(rounds > 2 * needed);
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
    Search search{bound, problem, candidates, parallel};
    const auto children = extended_under_guidance(search);
    REQUIRE_FALSE(children.empty());
    const EvaluatedHypothesis& best = children[best_of(children, problem.criteria)];
    CHECK(names_in(best) == "quadratic_drag");
    CHECK(best.hypothesis.parameters[0] == doctest::Approx(64).epsilon(0.01));
    CHECK(best.hypothesis.values[0][0] / 0.03 == doctest::Approx(1).epsilon(0.05));
    CHECK(trapped.loss > 100 * best.loss);
  }
  bound.structure.output_of = {-1, -1};
  const std::vector<AttachedEffect> nothing;
  Search search{bound, problem, nothing, serially()};
  CHECK(extended_under_guidance(search).empty());
}

}  // namespace
}  // namespace surefoot::diagnosis

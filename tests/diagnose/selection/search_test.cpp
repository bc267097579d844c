// The search for effects as a whole: with what it ends, and how sure it is of that.
#include "surefoot/diagnose/selection/search.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/effects/overflow.hpp"
#include "surefoot/diagnose/selection/propose.hpp"
#include "tests/diagnose/selection/tank_bench.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("the search ends with the two effects that act") {
  const TankBench bench({rate_in_tank, drift_in_tank});
  const Selection two = bench.found();
  CHECK(names_in(two.chosen) == "constant_rate, sensor_drift");
  CHECK(names_in(two.nominal).empty());
  CHECK(two.probability > 0.9);
  CHECK(two.candidates == 3);
  CHECK(two.fit.recordings == bench.problem.fit.recordings);
  REQUIRE(two.evidence.size() == 2);
  for (std::size_t e = 0; e < 2; ++e) {
    const double without = bench.search().without(two.chosen, e).errors.rms();
    CHECK(two.evidence[e].gain == doctest::Approx(1 - two.chosen.errors.rms() / without).epsilon(0.02));
    CHECK(two.evidence[e].p_value < 1e-3);
  }
  const auto value = [&](const std::string& name) {
    const auto& effects = two.chosen.hypothesis.effects;
    const auto place = std::ranges::find(effects, name, [](const AttachedEffect& one) { return one.effect->name; });
    return two.chosen.hypothesis.values.at(static_cast<std::size_t>(place - effects.begin()))[0];
  };
  CHECK(value("constant_rate") == doctest::Approx(0.2).epsilon(0.1));
  CHECK(value("sensor_drift") == doctest::Approx(0.05).epsilon(0.2));
}

/// Two tanks, the upper one of which no sensor sees, so that its unit is free: Bernoulli's law.
struct TwoTanks {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  SimulatorInfo info() const {
    return {.name = "two_tanks",
            .states = {{"upper", "V"}, {"lower", "V"}},
            .inputs = {{"pump", "V"}},
            .outputs = {{"lower_V", "V"}},
            .parameters = {{"k1", "1", 0.05, 0.005, 0.5},
                           {"k2", "1", 0.05, 0.005, 0.5},
                           {"k3", "1", 0.05, 0.005, 0.5},
                           {"k4", "1", 0.04, 0.004, 0.4}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    const double out = std::sqrt(std::max(x[0], 0.0));
    return {p[3] * u[0] - p[0] * out, p[1] * out - p[2] * std::sqrt(std::max(x[1], 0.0))};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[1]); }
};

/// Four recordings of two tanks with these effects, begun at levels that are not known.
std::vector<Recording> logs_of_tanks(const std::vector<NamedEffect>& effects) {
  std::vector<Recording> logs;
  Rng rng(5);
  for (int r = 0; r < 4; ++r) {
    Recording log = toys::blank_recording(TwoTanks{}.info(), 200, 4);
    log.name = "tanks " + std::to_string(r);
    log.initial = Vec<2>(5, 5);
    log.initial_scale = Vec<2>(5, 5);
    double pump = 3;
    for (Eigen::Index i = 0; i < log.rows(); ++i) {
      if (i % 20 == 0) pump = 1.5 + 4 * rng.uniform();
      log.inputs(0, i) = pump;
    }
    log.outputs = simulate_augmented(TwoTanks{}, toys::machine({0.06, 0.055, 0.05, 0.05}, effects), log).outputs;
    for (double& level : log.outputs.reshaped()) level += 0.03 * rng.normal();
    logs.push_back(std::move(log));
  }
  return logs;
}

TEST_CASE("two tanks that both overflow are found, though neither overflow explains much without the other") {
  const std::vector<Recording> logs =
      logs_of_tanks({{"overflow", "upper", "spill", "lower", {8, 0.5}}, {"overflow", "lower", {}, {}, {9}}});
  const Diagnosis found = diagnose(TwoTanks{}, logs, DiagnoseOptions{}, Threads{}, 1);
  INFO(found.sentence);
  CHECK(found.verdict == Verdict::missing_physics);
  std::vector<std::string> labels;
  for (const FoundEffect& one : found.effects) labels.push_back(one.name + " at " + one.attached_to);
  std::sort(labels.begin(), labels.end());
  CHECK(labels == std::vector<std::string>{"overflow at lower", "overflow at upper"});
  CHECK(found.noise_ratio < 1.2);
}

TEST_CASE("a tank that begins high may overflow far below that") {
  std::vector<Recording> logs = logs_of_tanks({{"overflow", "upper", "spill", "lower", {9, 0.5}}});
  logs[0].initial[0] = 22;  // as far as the model knows
  BoundSimulator bound = bind_simulator(TwoTanks{}, logs);
  Hypothesis base = nominal_hypothesis(bound);
  base.parameters = Vec<4>(0.06, 0.055, 0.05, 0.05);
  FitProblem problem;
  problem.recordings = all_recordings(bound);
  const auto runs = simulate_all(bound, base, problem.recordings, {}, serially());
  problem.weighting.sigma = residual_sizes(bound, problem.recordings, runs);
  bound.sizes = measure_sizes(bound, base, problem.recordings, runs);
  const auto overflow = attachments(bound, {effects::overflow_spill()}, {true});
  const auto proposals = propose(bound, base, problem, overflow, 0, serially());
  REQUIRE_FALSE(proposals.empty());
  CHECK(proposals.front().effect.place == "upper");
  CHECK(proposals.front().gain > 0.5);
}

TEST_CASE("probabilities of the choice and of its alternatives add up to 1, the most probable first") {
  const Selection selection = TankBench({rate_in_tank}).found();
  const auto& others = selection.alternative_probabilities;
  CHECK(selection.probability + std::accumulate(others.begin(), others.end(), 0.0) == doctest::Approx(1));
  REQUIRE(others.size() == selection.alternatives.size());
  CHECK(std::ranges::is_sorted(others, std::ranges::greater{}));
  CHECK(names_in(selection.chosen) == "constant_rate");
  for (const EvaluatedHypothesis& one : selection.alternatives) CHECK(names_in(one) != "constant_rate");
}

TEST_CASE("where no effect acts none is chosen") {
  const Selection selection = TankBench({}).found();
  CHECK(names_in(selection.chosen).empty());
  CHECK(selection.evidence.empty());
  CHECK(selection.probability > 0.5);
  CHECK_FALSE(selection.alternatives.empty());  // they were tried
}

TEST_CASE("of residuals that look like noise only strong proposals get a fit") {
  TankBench bench({});
  bench.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  CHECK(bench.found().alternatives.empty());
  TankBench strong({rate_in_tank});
  strong.problem.structured = [](const Hypothesis&, const FitProblem&) { return false; };
  CHECK(names_in(strong.found().chosen) == "constant_rate");
}

TEST_CASE("a search that is stopped at once chooses nothing") {
  TankBench bench({rate_in_tank});
  bench.problem.stopped = [] { return true; };
  const Selection selection = bench.found();
  CHECK(names_in(selection.chosen).empty());
  CHECK(selection.probability == doctest::Approx(1));
}

TEST_CASE("effects that are known already are kept, not counted, and not chosen") {
  TankBench bench({rate_in_tank, drift_in_tank});
  bench.problem.known = 1;
  bench.problem.nominal = bench.start({"constant_rate"});
  const Selection selection = bench.found();
  CHECK(names_in(selection.nominal) == "constant_rate");
  CHECK(names_in(selection.chosen) == "constant_rate, sensor_drift");
  CHECK(selection.evidence.size() == 1);
}

TEST_CASE("the search is the same however its work is shared out") {
  TankBench one({rate_in_tank}), other({rate_in_tank});
  other.parallel = [](std::size_t count, const std::function<void(std::size_t)>& job) {
    for (std::size_t i = count; i > 0; --i) job(i - 1);
  };
  const Selection a = one.found(), b = other.found();
  CHECK(a.probability == b.probability);
  CHECK(a.alternative_probabilities == b.alternative_probabilities);
  CHECK(a.chosen.hypothesis.values == b.chosen.hypothesis.values);
}

TEST_CASE("a search in many recordings looks at some that differ, and fits to all what it finds") {
  TankBench bench({rate_in_tank});
  bench.problem.screened = {0, 1};
  const Hypothesis nominal = bench.problem.nominal;
  CHECK(informative(bench.bound, nominal, bench.problem, bench.parallel) == bench.problem.fit.recordings);
  bench.problem.effort.rows = 400;
  const auto some = informative(bench.bound, nominal, bench.problem, bench.parallel);
  CHECK(some.size() == 4);
  CHECK(std::ranges::is_sorted(some));
  bench.problem.effort.rows = 1;
  CHECK(informative(bench.bound, nominal, bench.problem, bench.parallel).size() == 2);  // as many as are screened
  const Selection selection = bench.found();
  CHECK(names_in(selection.chosen) == "constant_rate");
  CHECK(selection.fit.recordings.size() == 6);
  CHECK(selection.chosen.errors.mean_squares.rows() == 6);
  CHECK(selection.nominal.errors.mean_squares.rows() == 6);
}

}  // namespace
}  // namespace surefoot::diagnosis

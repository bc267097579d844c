// The search for effects: what is taken back, and what takes the place of what.
#include "surefoot/diagnose/selection/search.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/diagnose/effects/constant_rate.hpp"
#include "surefoot/diagnose/effects/sensor_bias.hpp"
#include "surefoot/diagnose/effects/sensor_drift.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

// Six tanks that these effects act on, with noise of 1 cm, and the search in them.
struct TankBench {
  BoundSimulator bound;
  SearchProblem problem;
  std::vector<AttachedEffect> candidates;
  Parallel parallel = serially();
  Search search{bound, problem, candidates, parallel};

  explicit TankBench(const std::vector<NamedEffect>& truth) {
    std::vector<Recording> recordings;
    Rng rng(1);
    for (int r = 0; r < 6; ++r) {
      Recording recording = toys::tank_recording(r, 120);
      recording.outputs = simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}, truth), recording).outputs;
      for (double& level : recording.outputs.reshaped()) level += 0.01 * rng.normal();
      recordings.push_back(std::move(recording));
    }
    bound = bind_simulator(toys::LeakyTank{}, recordings);
    problem.fit.recordings = problem.screened = {0, 1, 2, 3, 4, 5};
    problem.fit.weighting.sigma.setConstant(1, 0.01);
    problem.folds = {{0, 1}, {2, 3}, {4, 5}};
    const Hypothesis nominal = nominal_hypothesis(bound);
    const auto runs = simulate_all(bound, nominal, problem.fit.recordings, {}, parallel);
    bound.sizes = measure_sizes(bound, nominal, problem.fit.recordings, runs);
    candidates = attachments(bound, {effects::constant_rate(), effects::sensor_drift(), effects::sensor_bias()},
                             std::vector<bool>(2, true));
  }
  TankBench(const TankBench&) = delete;
  TankBench& operator=(const TankBench&) = delete;

  /// A fit with these effects, as it is evaluated.
  EvaluatedHypothesis with(const std::vector<std::string>& names) const {
    Hypothesis start = nominal_hypothesis(bound);
    for (const std::string& name : names) {
      const auto of_name = [&](const AttachedEffect& one) { return one.effect->name == name; };
      start.effects.push_back(*std::find_if(candidates.begin(), candidates.end(), of_name));
      start.values.emplace_back(Eigen::VectorXd::Constant(1, 0.01));
    }
    return evaluate_fit(bound, fit(bound, start, problem.fit, parallel), problem, parallel);
  }
};

std::string names_in(const EvaluatedHypothesis& evaluated) {
  std::vector<std::string> names;
  for (const AttachedEffect& one : evaluated.hypothesis.effects) names.push_back(one.effect->name);
  std::sort(names.begin(), names.end());
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

const NamedEffect rate{"constant_rate", "level", {}, {}, {0.2}}, drift{"sensor_drift", "level_m", {}, {}, {0.05}};

TEST_CASE("an effect that another one made idle is dropped") {
  const TankBench bench({rate});
  EvaluatedHypothesis chosen = bench.with({"sensor_drift", "constant_rate"});
  drop_idle_effects(bench.search, chosen);
  CHECK(names_in(chosen) == "constant_rate");
}

TEST_CASE("two effects that both do something stay") {
  const TankBench bench({rate, drift});
  EvaluatedHypothesis chosen = bench.with({"sensor_drift", "constant_rate"});
  drop_idle_effects(bench.search, chosen);
  CHECK(names_in(chosen) == "constant_rate, sensor_drift");
}

TEST_CASE("a pair takes the place of one effect that leaves something open") {
  const TankBench bench({rate, drift});
  Selection selection;
  selection.nominal = bench.with({});
  selection.chosen = bench.with({"sensor_bias"});
  try_pair_instead(bench.search, selection);
  CHECK(names_in(selection.chosen) == "constant_rate, sensor_drift");
}

TEST_CASE("an effect that stands where another one does better is replaced, until none does") {
  const TankBench bench({rate, drift});
  Selection selection;
  selection.nominal = bench.with({});
  selection.chosen = bench.with({"constant_rate", "sensor_bias"});
  int rounds = 0;
  while (rounds < 5 && compare_with_others(bench.search, selection, true)) ++rounds;
  CHECK(rounds > 0);
  CHECK(rounds < 5);
  CHECK(names_in(selection.chosen) == "constant_rate, sensor_drift");
  CHECK(selection.evidence.size() == 2);
}

TEST_CASE("the search ends with the effects that act, and with none where none acts") {
  const TankBench both({rate, drift}), none({});
  const auto found = [](const TankBench& bench) {
    const Fit calibrated = fit(bench.bound, nominal_hypothesis(bench.bound), bench.problem.fit, bench.parallel);
    return select_effects(bench.bound, calibrated, bench.problem, bench.candidates, bench.parallel);
  };
  const Selection two = found(both);
  CHECK(names_in(two.chosen) == "constant_rate, sensor_drift");
  CHECK(two.evidence.size() == 2);
  CHECK(two.candidates == 3);
  CHECK(names_in(found(none).chosen).empty());
}

TEST_CASE("a search that is stopped at once chooses nothing") {
  TankBench bench({rate});
  bench.problem.stopped = [] { return true; };
  const Fit calibrated = fit(bench.bound, nominal_hypothesis(bench.bound), bench.problem.fit, bench.parallel);
  CHECK(names_in(select_effects(bench.bound, calibrated, bench.problem, bench.candidates, bench.parallel).chosen)
            .empty());
}

TEST_CASE("of residuals that look like noise only strong proposals are worth a fit") {
  const TankBench bench({});
  const Hypothesis nominal = nominal_hypothesis(bench.bound);
  const auto some = shortlisted(bench.bound, nominal, bench.problem, bench.candidates, 10, true, bench.parallel);
  CHECK_FALSE(some.empty());
  CHECK(shortlisted(bench.bound, nominal, bench.problem, bench.candidates, 10, false, bench.parallel).empty());
  CHECK(shortlisted(bench.bound, nominal, bench.problem, bench.candidates, 1, true, bench.parallel).size() == 1);
}

}  // namespace
}  // namespace surefoot::diagnosis

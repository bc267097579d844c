#include "surefoot/solve/rfpi_adapt.hpp"

#include <doctest/doctest.h>

#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/support/double_integrator.hpp"
#include "tests/support/pendulum.hpp"

namespace surefoot::detail {
namespace {

TEST_CASE("noise in the simulator is noticed") {
  CHECK(is_deterministic(toy::DoubleIntegrator{}, 50, Rng(1)));
  CHECK(is_deterministic(toy::Pendulum{}, 200, Rng(1)));
  CHECK_FALSE(is_deterministic(toy::DoubleIntegrator{.push = 1e-9}, 50, Rng(1)));
}

TEST_CASE("without noise one sample is enough") {
  const RfpiOptions options = without_noise({});
  CHECK(options.lookahead.samples == 1);
  CHECK(options.lookahead.refined_samples == 1);
  CHECK(options.backup_runs == 1);
  CHECK(options.backup_steps > RfpiOptions{}.backup_steps);
  CHECK(options.replace_short_runs);
  CHECK(options.try_following);
  CHECK_FALSE(without_noise({.lookahead = {.follow = 2}}).try_following);
  CHECK(options.value_forest.model_score);
}

TEST_CASE("without noise a run is no more than ten backups, in steps of any length and however early it ends") {
  const RfpiOptions options = without_noise({.horizon = 2000});
  CHECK(backup_steps_for(20, options) == 6);
  CHECK(backup_steps_for(200, options) == 20);
  CHECK(backup_steps_for(2000, options) == 200);
  CHECK(backup_steps_for(200, without_noise({.backup_steps = 30})) == 30);
}

TEST_CASE("with noise, and where nothing adapts, backups are as long as the options say") {
  CHECK(backup_steps_for(200, {.backup_steps = 3}) == 3);
  CHECK(backup_steps_for(200, {.backup_steps = 3, .backup_weight = 1, .adapt = false}) == 3);
}

TEST_CASE("sizes of policies are tried in turn, and stay in bounds") {
  CHECK(other_size(100, 1000, 0) == 300);
  CHECK(other_size(100, 1000, 1) == 33);
  CHECK(other_size(1000, 1000, 0) == 333);
  CHECK(other_size(1, 1000, 1) == 3);
  CHECK(other_size(1, 1, 0) == 1);
  CHECK(other_size(500, 1000, 0) == 1000);
}

TEST_CASE("evaluation runs fit the horizon unless they are given") {
  CHECK(evaluation_runs({.horizon = 50}) == 1000);
  CHECK(evaluation_runs({.horizon = 1000}) == 200);
  CHECK(evaluation_runs({.horizon = 1000, .evaluation_runs = 7}) == 7);
}

TEST_CASE("runs are in transition until nine tenths have come of what sets them apart from their end") {
  std::vector<double> costs(50, 0.25);  // what goes on and on does not count
  for (std::size_t t = 0; t < 20; ++t) costs[t] = 1;
  CHECK(transient_of(costs) == 18);
  for (double& cost : costs) cost = -cost;  // rewards that come from a goal on
  CHECK(transient_of(costs) == 18);
}

TEST_CASE("runs without a beginning of their own are in transition to their end") {
  CHECK(transient_of(std::vector<double>(50, 0.25)) == 50);
  CHECK(transient_of(std::vector<double>{3}) == 1);
}

TEST_CASE("a policy does better by more than the error of the mean difference, on the same runs") {
  const auto of = [](std::vector<double> runs) {
    PolicyCost cost;
    cost.runs = std::move(runs);
    return cost;
  };
  const PolicyCost usual = of({10, 200, 30, 4});
  CHECK(does_better(of({9, 199, 29, 3}), usual));  // always by 1, however much the runs differ
  CHECK_FALSE(does_better(of({0, 209, 20, 12}), usual));
  CHECK_FALSE(does_better(usual, usual));
}

TEST_CASE("the cost of a policy is the one that evaluate() finds") {
  const toy::Pendulum problem;
  Dataset<3, 1> data;
  data.inputs = Eigen::MatrixXf::Random(3, 50);
  data.outputs = 2 * Eigen::MatrixXd::Random(1, 50);
  const auto forest = train_extra_trees<LinearLeaf>(data, {.trees = 3}, Serial{}, 1);
  RfpiOptions options{.discount = 0.9, .horizon = 30};
  const PolicyCost cost = policy_cost(problem, forest, options, 70, Threads(2), 5);
  const ForestPolicy<toy::Pendulum> policy(problem, forest, options.agreement);
  const RolloutOptions runs{.runs = 70, .horizon = 30};
  CHECK(cost.cost.mean == doctest::Approx(-evaluate(problem, policy, runs, Serial{}, 5).mean).epsilon(1e-12));
  const RolloutOptions discounted{.runs = 70, .horizon = 30, .discount = 0.9};
  CHECK(cost.length == 30);
  CHECK(cost.runs.size() == 70);
  CHECK(cost.transient >= 1);
  CHECK(cost.transient <= 30);
  CHECK(cost.discounted == doctest::Approx(-evaluate(problem, policy, discounted, Serial{}, 5).mean).epsilon(1e-12));
}

}  // namespace
}  // namespace surefoot::detail

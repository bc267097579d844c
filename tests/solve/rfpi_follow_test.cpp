#include "surefoot/solve/rfpi_follow.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/support/double_integrator.hpp"

namespace surefoot::detail {
namespace {

using toy::DoubleIntegrator;
using toy::DoubleIntegratorOptimum;

/// With steps of half a second six of them are most of what the best feedback takes.
const DoubleIntegrator slow_mass{.time_step = 0.5};
const DoubleIntegratorOptimum slow_optimum(slow_mass, 200);

double feedback(const Vec<2>& x) { return DoubleIntegratorOptimum(slow_optimum)(x)[0]; }

template <class Output>
Forest<2, 1, LinearLeaf> learnt_forest(const Output& output, int trees) {
  Rng rng(1);
  Dataset<2, 1> data;
  data.inputs.resize(2, 3000);
  data.outputs.resize(1, 3000);
  for (int i = 0; i < 3000; ++i) {
    const Vec<2> x = slow_mass.state_box().sample(rng);
    data.inputs.col(i) = x.cast<float>();
    data.outputs(0, i) = output(x, rng);
  }
  return train_extra_trees<LinearLeaf>(data, {.trees = trees, .min_leaf = 10}, Serial{}, 1);
}

/// A training in which the policy is good and the values are wrong by `noise`, each tree by its own.
RfpiState<DoubleIntegrator> state_with(double noise) {
  RfpiState<DoubleIntegrator> state;
  state.policy = learnt_forest([](const Vec<2>& x, Rng&) { return feedback(x); }, 4);
  state.value.forest = learnt_forest(
      [&](const Vec<2>& x, Rng& rng) { return slow_optimum.expected_return(x) + noise * rng.normal(); }, 4);
  Rng rng(2);
  for (int i = 0; i < 800; ++i) {
    state.samples.states.push_back(Vec<2>(rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5)));
  }
  return state;
}

RfpiOptions following_options() {
  RfpiOptions options = without_noise(resolved({.horizon = 50}));
  options.evaluation_runs = 50;
  return options;
}

/// Root mean square distance of a lookahead's actions from the good feedback's [m/s^2].
double error_of_actions(double noise, int follow) {
  const RfpiState<DoubleIntegrator> state = state_with(noise);
  RfpiOptions options = following_options();
  options.lookahead.follow = follow;
  RfpiWork work;
  const ForestPolicy<DoubleIntegrator> policy(slow_mass, state.policy);
  const auto found =
      look_ahead_from_some(slow_mass, options, state, policy, state.samples, Threads(2), Rng(3), work, {});
  double sum = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    sum += std::pow(found.actions[i][0] - feedback(found.states[i]), 2);
  }
  return std::sqrt(sum / static_cast<double>(found.size()));
}

TEST_CASE("where values err, lookaheads that follow a good policy find better actions") {
  CHECK(error_of_actions(1, followed) < 0.8 * error_of_actions(1, 0));
}

TEST_CASE("every fourth state is looked at in a trial, and its work is counted") {
  const RfpiState<DoubleIntegrator> state = state_with(0);
  RfpiOptions options = following_options();
  options.lookahead.follow = 3;
  RfpiWork work;
  const ForestPolicy<DoubleIntegrator> policy(slow_mass, state.policy);
  const auto found = look_ahead_from_some(slow_mass, options, state, policy, state.samples, Serial{}, Rng(3), work, {});
  CHECK(found.size() == 200);
  CHECK(found.states[1] == state.samples.states[4]);
  CHECK(work.steps == 200 * 23 * 4);                         // 11 + 12 actions, one transition and three that follow
  CHECK(work.lookups == 200 * (23 * 4 + (1 + 23 * 3) * 4));  // four trees each
}

TEST_CASE("the other way is taken if it does better than the usual one, and only then") {
  const RfpiOptions options = following_options();
  RfpiState<DoubleIntegrator> before = state_with(0);
  const ForestPolicy<DoubleIntegrator> policy(slow_mass, before.policy);
  for (const bool follows : {false, true}) {
    before.follows = follows;
    RfpiState<DoubleIntegrator> after = before;
    after.leaves = 10;
    PolicyCost usual;
    usual.discounted = -std::numeric_limits<double>::infinity();
    PolicyCost taken = try_other_way(slow_mass, options, before, after, policy, usual, Serial{}, Rng(4), 5, {});
    CHECK(after.follows == follows);
    CHECK(after.policy == before.policy);
    CHECK(taken.discounted == usual.discounted);

    usual.discounted = std::numeric_limits<double>::infinity();
    taken = try_other_way(slow_mass, options, before, after, policy, usual, Serial{}, Rng(4), 5, {});
    CHECK(after.follows != follows);
    CHECK_FALSE(after.policy == before.policy);
    CHECK(taken.length == 50);
    CHECK(taken.cost.mean > 0);
  }
}

}  // namespace
}  // namespace surefoot::detail

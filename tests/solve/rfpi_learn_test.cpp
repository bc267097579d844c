#include "surefoot/solve/rfpi_learn.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "surefoot/core/executor.hpp"
#include "tests/support/double_integrator.hpp"

namespace surefoot::detail {
namespace {

using toy::DoubleIntegrator;

const DoubleIntegrator mass;

/// Samples of the best feedback over the box, as an iteration leaves them.
RfpiState<DoubleIntegrator> state_with_samples() {
  const toy::DoubleIntegratorOptimum optimum(mass, 200);
  RfpiState<DoubleIntegrator> state;
  Rng rng(1);
  for (int i = 0; i < 3000; ++i) {
    const Vec<2> x = mass.state_box().sample(rng);
    state.samples.states.push_back(x);
    state.samples.actions.push_back(mass.action_box().clamp(toy::DoubleIntegratorOptimum(optimum)(x)));
    state.samples.values.push_back(optimum.expected_return(x));
  }
  return state;
}

RfpiOptions learning_options() {
  RfpiOptions options = resolved({.horizon = 50});
  options.evaluation_runs = 40;
  return options;
}

TEST_CASE("a learnt policy costs what evaluation says, and the work of both is counted") {
  const RfpiOptions options = learning_options();
  RfpiState<DoubleIntegrator> before, after = state_with_samples();
  const PolicyCost cost = learn_policy(mass, options, before, after, Serial{}, Rng(1), 7, {});
  CHECK(cost.cost.mean < 1.3 * -toy::DoubleIntegratorOptimum(mass, 50).expected_return());
  CHECK(after.work.steps == 2 * 40 * 50);  // of both sizes
  CHECK(after.work.lookups == after.work.steps * after.policy.trees());
  CHECK(after.work.fits > 0);
  RfpiWork work;
  const PolicyCost again = counted_cost(mass, after.policy, options, Threads(2), 7, work);
  CHECK(again.cost.mean == cost.cost.mean);
  CHECK(again.discounted == cost.discounted);
  CHECK(again.length == 50);
}

TEST_CASE("of two sizes the policy that clearly does better is kept") {
  RfpiOptions options = learning_options();
  RfpiState<DoubleIntegrator> before;
  before.iteration = 1;  // tries a third
  before.leaves = 9;
  RfpiState<DoubleIntegrator> after = state_with_samples();
  const PolicyCost kept = learn_policy(mass, options, before, after, Serial{}, Rng(1), 7, {});
  options.adapt = false;
  std::vector<PolicyCost> costs;
  for (const int leaves : {9, 3}) {
    options.policy_forest.max_leaves = leaves;
    RfpiState<DoubleIntegrator> one = state_with_samples();
    const PolicyCost cost = learn_policy(mass, options, before, one, Serial{}, Rng(1), 7, {});
    CHECK(one.leaves == leaves);
    if (leaves == after.leaves) CHECK(kept.discounted == cost.discounted);
    costs.push_back(cost);
  }
  CHECK(after.leaves == (does_better(costs[1], costs[0]) ? 3 : 9));
}

TEST_CASE("where the policy has the largest size, a smaller one is tried every third iteration") {
  RfpiOptions options = learning_options();
  options.policy_forest.max_leaves = 9;
  for (int iteration = 3; iteration < 6; ++iteration) {
    RfpiState<DoubleIntegrator> before, after = state_with_samples();
    before.iteration = iteration;
    before.leaves = 9;
    learn_policy(mass, options, before, after, Serial{}, Rng(1), 7, {});
    CHECK(after.work.steps == (iteration == 3 ? 2 : 1) * 40 * 50);
  }
}

TEST_CASE("now and then opinions of the other kind are tried, and kept where they do better") {
  RfpiOptions options = learning_options();
  options.policy_forest.max_leaves = 1;
  RfpiState<DoubleIntegrator> samples = state_with_samples();
  for (std::size_t i = 0; i < samples.samples.size(); ++i) {  // full left or full right, the leaf lies across the step
    samples.samples.actions[i][0] = samples.samples.states[i].sum() < 0 ? 1.5 : -1.5;
  }
  const auto cost_by = [&](OpinionsOf opinions) {
    RfpiWork work;
    const auto policy =
        fit_policy(mass, samples.samples, {}, opinions, options.policy_forest, Serial{}, Rng(1), work, {});
    return counted_cost(mass, policy, options, Serial{}, 7, work).discounted;
  };
  const double by_distances = cost_by(OpinionsOf::distances), by_actions = cost_by(OpinionsOf::actions);
  REQUIRE(by_distances != by_actions);
  const OpinionsOf best = by_distances < by_actions ? OpinionsOf::distances : OpinionsOf::actions;
  for (const OpinionsOf first : {OpinionsOf::distances, OpinionsOf::actions}) {
    RfpiState<DoubleIntegrator> before, after = samples;
    before.leaves = 1;
    before.opinions = first;
    before.iteration = opinions_tried_at + 1;
    learn_policy(mass, options, before, after, Serial{}, Rng(1), 7, {});
    CHECK(after.opinions == first);
    before.iteration = opinions_tried_at;
    learn_policy(mass, options, before, after, Serial{}, Rng(1), 7, {});
    CHECK(after.opinions == best);
  }
}

TEST_CASE("a value forest has learnt the values of its samples") {
  const RfpiState<DoubleIntegrator> state = state_with_samples();
  RfpiWork work;
  const auto value =
      fit_value<LinearLeaf>(mass, state.samples, {}, learning_options().value_forest, Serial{}, Rng(1), work, {});
  const Vec<2> x(0.5, -0.3);
  const Eigen::Vector2f row = x.cast<float>();
  double found = 0;
  value.predict(row.data(), 1, &found);
  CHECK(found == doctest::Approx(toy::DoubleIntegratorOptimum(mass, 200).expected_return(x)).epsilon(0.02));
  CHECK(work.fits > 0);
}

}  // namespace
}  // namespace surefoot::detail

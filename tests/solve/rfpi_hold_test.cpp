#include "surefoot/solve/rfpi_hold.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/support/double_integrator.hpp"

namespace surefoot::detail {
namespace {

using Problem2 = toy::DoubleIntegrator;

/// A tree that has learnt minus the squared distance from the origin, and noise.
Forest<2, 1, LinearLeaf> tree_with_noise(double noise, std::uint64_t seed) {
  Rng rng(seed);
  Dataset<2, 1> data;
  data.inputs.resize(2, 2000);
  data.outputs.resize(1, 2000);
  for (int i = 0; i < 2000; ++i) {
    const Vec<2> x = Problem2{}.state_box().sample(rng);
    data.inputs.col(i) = x.cast<float>();
    data.outputs(0, i) = -x.squaredNorm() + noise * rng.normal();
  }
  return train_extra_trees<LinearLeaf>(data, {.trees = 1, .min_leaf = 5, .model_score = false}, Serial{}, 1);
}

/// Twelve of them, each with noise of its own.
ValueForest<2> value_with_noise(double noise) {
  std::vector<Forest<2, 1, LinearLeaf>> trees;
  for (std::uint64_t seed = 0; seed < 12; ++seed) trees.push_back(tree_with_noise(noise, seed));
  return {{}, merge(std::span<const Forest<2, 1, LinearLeaf>>(trees))};
}

std::vector<Vec<2>> some_states() {
  Rng rng(2);
  std::vector<Vec<2>> states;
  for (int i = 0; i < 64; ++i) states.push_back(Problem2{}.state_box().sample(rng));
  return states;
}

TEST_CASE("actions are held for longer where the values err more") {
  const auto states = some_states();
  RfpiOptions options{.discount = 0.98};
  RfpiWork work;
  const auto hold = [&](double noise) {
    return chosen_hold(Problem2{}, value_with_noise(noise), std::span<const Vec<2>>(states), options, Rng(1), work);
  };
  CHECK(hold(0) == 1);
  CHECK(hold(10) > 1);
  CHECK(work.steps > 0);
  CHECK(work.lookups > 0);
  CHECK(chosen_hold(Problem2{}, ValueForest<2>{}, std::span<const Vec<2>>(states), options, Rng(1), work) == 1);
}

TEST_CASE("halves of a forest agree more the longer an action is held") {
  const auto states = some_states();
  const auto value = value_with_noise(0.5);
  const auto agreement = [&](int transitions) {
    return agreement_of_halves(Problem2{}, value, std::span<const Vec<2>>(states), 0.98, transitions, Rng(1));
  };
  CHECK(agreement(6) > agreement(1));
}

}  // namespace
}  // namespace surefoot::detail

// Prediction must not allocate.
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <span>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "tests/forest/samples.hpp"
#include "tests/support/allocation_count.hpp"

namespace surefoot {
namespace {

TEST_CASE_TEMPLATE("predicting allocates nothing", Leaf, ConstantLeaf, LinearLeaf) {
  const auto samples = toy::sample(toy::ClippedLaws{}, 300, 1);
  long before = allocations;
  const auto forest = train_extra_trees<Leaf>(samples, {}, Serial{}, 1);
  CHECK(allocations > before);  // the counter works
  const Vec<4> x = samples.inputs.col(0).cast<double>();
  typename Forest<4, 2, Leaf>::BatchOutput out(2, 300);
  before = allocations;
  const Vec<2> y = forest.predict(x);
  forest.predict(samples.inputs, out);
  forest.predict(samples.inputs.data(), 300, out.data());
  const MeanAndDeviation<2> spread = forest.predict_with_deviation(x);
  std::array<std::uint32_t, 25> leaves;
  forest.leaf_indices(x, std::span(leaves).first(forest.trees()));
  CHECK(allocations == before);
  CHECK(spread.mean == y);
  CHECK(out.col(0) == y);
}

}  // namespace
}  // namespace surefoot

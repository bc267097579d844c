#include "surefoot/forest/forest.hpp"

#include <doctest/doctest.h>

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

// What a forest must predict, by walking its trees one node after the other.
template <int I, int O, LeafModel Leaf>
Vec<O> walk(const Forest<I, O, Leaf>& forest, const Eigen::Matrix<float, I, 1>& x) {
  const Trees& trees = forest.raw();
  Vec<O> sum = Vec<O>::Zero(forest.outputs());
  for (std::size_t at : trees.roots) {
    while (!trees.nodes[at].is_leaf()) {
      const Node node = trees.nodes[at];
      at += node.distance() + (x[node.input()] > node.threshold() ? 1U : 0U);
    }
    const std::uint32_t payload = trees.nodes[at].payload();
    const auto value = std::bit_cast<float>(payload);
    const float* parameters =
        trees.inline_leaves() ? &value : trees.parameters.data() + payload * trees.leaf_parameters;
    Leaf::add(parameters, x.data(), forest.inputs(), forest.outputs(), sum.data());
  }
  return sum * (1.0 / static_cast<double>(forest.trees()));
}

template <class F, class Function>
void check_all_ways_agree(const F& forest, const Function& function) {
  const auto test = toy::sample(function, 777, 5);
  Eigen::Matrix<double, Function::outputs, Eigen::Dynamic> batch;
  forest.predict(test.inputs, batch);
  REQUIRE(batch.cols() == 777);
  std::vector<double> raw(777 * Function::outputs, 99.0);
  forest.predict(test.inputs.data(), 777, raw.data());
  int differences = 0;
  for (Eigen::Index i = 0; i < 777; ++i) {
    const Eigen::Matrix<float, Function::inputs, 1> x = test.inputs.col(i);
    const Vec<Function::outputs> expected = walk(forest, x);
    if (forest.predict(x.template cast<double>()) != expected) ++differences;
    if (batch.col(i) != expected) ++differences;
    if (Eigen::Map<Vec<Function::outputs>>(raw.data() + i * Function::outputs) != expected) ++differences;
  }
  CHECK(differences == 0);
}

TEST_CASE_TEMPLATE("one by one, as a batch and by hand a forest predicts the same bits", Leaf, ConstantLeaf,
                   LinearLeaf) {
  for (const int trees : {1, 7, 8, 9, 25, 40, 70}) {
    CAPTURE(trees);
    const ExtraTreesOptions options{.trees = trees, .min_leaf = 8};
    check_all_ways_agree(train_extra_trees<Leaf>(toy::sample(toy::Cliff{}, 500, 1), options, Serial{}, 1),
                         toy::Cliff{});
    check_all_ways_agree(train_extra_trees<Leaf>(toy::sample(toy::ClippedLaws{}, 500, 2), options, Serial{}, 1),
                         toy::ClippedLaws{});
  }
}

TEST_CASE("a batch of neighbours takes the same paths as its members alone") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 3000, 1), {.min_leaf = 1}, Serial{}, 1);
  Rng rng(3);
  for (int group = 0; group < 20; ++group) {
    Forest<5, 1>::Batch batch(5, 50);
    const Vec<5> center = Vec<5>::Constant(rng.uniform(-1, 1));
    const double spread = std::pow(10.0, rng.uniform(-6, 0));
    for (int i = 0; i < 50; ++i) {
      for (int k = 0; k < 5; ++k) batch(k, i) = static_cast<float>(center[k] + spread * rng.uniform(-1, 1));
    }
    Forest<5, 1>::BatchOutput out;
    forest.predict(batch, out);
    for (int i = 0; i < 50; ++i) CHECK(out(0, i) == walk<5, 1, ConstantLeaf>(forest, batch.col(i))[0]);
  }
}

TEST_CASE("inputs that are infinite or no numbers still lead to a leaf, NaN to the left") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 500, 1), {}, Serial{}, 1);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Vec<5> nowhere = Vec<5>::Constant(std::numeric_limits<double>::quiet_NaN());
  const Vec<5> lowest = Vec<5>::Constant(-infinity);
  CHECK(forest.predict(nowhere) == forest.predict(lowest));
  CHECK(std::isfinite(forest.predict(Vec<5>::Constant(infinity))[0]));
  CHECK(forest.predict(Vec<5>::Constant(-0.0)) == forest.predict(Vec<5>::Zero()));
}

TEST_CASE("sizes may be known at run time only") {
  const auto fixed_samples = toy::sample(toy::ClippedLaws{}, 400, 1);
  const Dataset<Eigen::Dynamic, Eigen::Dynamic> samples{fixed_samples.inputs, fixed_samples.outputs, {}};
  const auto fixed = train_extra_trees<LinearLeaf>(fixed_samples, {.min_leaf = 10}, Serial{}, 1);
  const auto dynamic = train_extra_trees<LinearLeaf>(samples, {.min_leaf = 10}, Serial{}, 1);
  CHECK(fixed.raw() == dynamic.raw());
  Eigen::MatrixXd out;
  dynamic.predict(samples.inputs, out);
  for (Eigen::Index i = 0; i < 400; ++i) {
    const Eigen::VectorXd x = samples.inputs.col(i).cast<double>();
    CHECK(out.col(i) == dynamic.predict(x));
    CHECK(out.col(i) == fixed.predict(x));
  }
}

TEST_CASE("many inputs take the paths that few inputs take") {
  // Enough inputs for each way of holding their keys: one register, two, and none.
  for (const int inputs : {6, 7, 8, 15, 16, 40, 255}) {
    CAPTURE(inputs);
    Rng rng(1);
    Dataset<Eigen::Dynamic, 1> samples;
    samples.inputs.resize(inputs, 300);
    samples.outputs.resize(1, 300);
    for (Eigen::Index i = 0; i < 300; ++i) {
      for (int k = 0; k < inputs; ++k) samples.inputs(k, i) = static_cast<float>(rng.normal());
      samples.outputs(0, i) = rng.normal();
    }
    const auto forest = train_extra_trees(samples, {.trees = 10, .candidates = 3, .min_leaf = 1}, Serial{}, 1);
    Eigen::RowVectorXd out;
    forest.predict(samples.inputs, out);
    int differences = 0;
    for (Eigen::Index i = 0; i < 300; ++i) {
      const Eigen::VectorXf x = samples.inputs.col(i);
      const double expected = walk(forest, x)[0];
      if (out[i] != expected || forest.predict(x.cast<double>())[0] != expected) ++differences;
    }
    CHECK(differences == 0);
  }
}

TEST_CASE("a batch may be a block of a larger matrix") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 300, 1), {}, Serial{}, 1);
  const Eigen::MatrixXf wide = Eigen::MatrixXf::Random(9, 20);
  Forest<5, 1>::BatchOutput out;
  forest.predict(wide.block(2, 3, 5, 10), out);
  for (Eigen::Index i = 0; i < 10; ++i)
    CHECK(out(0, i) == forest.predict(wide.block<5, 1>(2, 3 + i).cast<double>())[0]);
}

TEST_CASE("an empty batch gives nothing") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 300, 1), {}, Serial{}, 1);
  Forest<5, 1>::BatchOutput out(1, 3);
  forest.predict(Forest<5, 1>::Batch(5, 0), out);
  CHECK(out.cols() == 0);
}

TEST_CASE("merged forests predict the mean of their trees") {
  const auto samples = toy::sample(toy::ClippedLaws{}, 400, 1);
  for (const bool linear : {false, true}) {
    auto check_merge = [&]<LeafModel Leaf>(Leaf) {
      const std::array<Forest<4, 2, Leaf>, 3> parts{
          train_extra_trees<Leaf>(samples, {.trees = 5, .min_leaf = 10}, Serial{}, 1),
          train_extra_trees<Leaf>(samples, {.trees = 10, .min_leaf = 20}, Serial{}, 2),
          train_extra_trees<Leaf>(samples, {.trees = 5, .min_leaf = 5}, Serial{}, 3)};
      const auto merged = merge(std::span<const Forest<4, 2, Leaf>>(parts));
      CHECK(merged.trees() == 20);
      CHECK(merged.leaves() == parts[0].leaves() + parts[1].leaves() + parts[2].leaves());
      for (Eigen::Index i = 0; i < 50; ++i) {
        const Vec<4> x = samples.inputs.col(i).cast<double>();
        const Vec<2> mean = 0.25 * parts[0].predict(x) + 0.5 * parts[1].predict(x) + 0.25 * parts[2].predict(x);
        CHECK((merged.predict(x) - mean).norm() < 1e-12);
      }
    };
    linear ? check_merge(LinearLeaf{}) : check_merge(ConstantLeaf{});
  }
}

TEST_CASE("forests of different shapes cannot be merged or taken over") {
  using Dynamic = Forest<Eigen::Dynamic, Eigen::Dynamic>;
  const auto small = train_extra_trees(toy::sample(toy::Cliff{}, 50, 1), {}, Serial{}, 1);
  const auto large = train_extra_trees(toy::sample(toy::ClippedLaws{}, 50, 1), {}, Serial{}, 1);
  const std::array<Dynamic, 2> parts{Dynamic(small.raw()), Dynamic(large.raw())};
  CHECK_THROWS_WITH_AS(merge(std::span<const Dynamic>(parts)), doctest::Contains("5 inputs"), ForestError);
  CHECK_THROWS_AS((Forest<5, 1>(large.raw())), ForestError);
  CHECK_THROWS_AS((Forest<5, 1, LinearLeaf>(small.raw())), ForestError);
  CHECK_THROWS_AS(merge(std::span<const Dynamic>()), ForestError);
}

TEST_CASE("a forest knows its size") {
  CHECK(Forest<5, 1>().empty());
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 300, 1), {.trees = 6}, Serial{}, 1);
  CHECK_FALSE(forest.empty());
  CHECK(forest.trees() == 6);
  CHECK(forest.leaves() > 6 * 20);
  CHECK(forest.bytes() > 16 * forest.leaves());  // two nodes of 8 bytes for each leaf, and some room
  CHECK(forest.bytes() < 20 * forest.leaves());
}

}  // namespace
}  // namespace surefoot

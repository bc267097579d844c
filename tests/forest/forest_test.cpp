#include "surefoot/forest/forest.hpp"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/serialize.hpp"
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

TEST_CASE("a batch of any size gives what its members give alone") {
  const auto samples = toy::sample(toy::ClippedLaws{}, 600, 1);
  const auto forest = train_extra_trees(samples, {.trees = 20, .min_leaf = 2}, Serial{}, 1);
  for (const std::size_t count : {1U, 2U, 8U, 31U, 32U, 33U, 39U, 255U, 256U, 257U, 288U, 289U, 600U}) {
    std::vector<double> out(2 * count, 99.0);
    forest.predict(samples.inputs.data(), count, out.data());
    int differences = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec<2> expected = walk<4, 2, ConstantLeaf>(forest, samples.inputs.col(static_cast<Eigen::Index>(i)));
      differences += out[2 * i] != expected[0] || out[2 * i + 1] != expected[1] ? 1 : 0;
    }
    CAPTURE(count);
    CHECK(differences == 0);
  }
}

TEST_CASE_TEMPLATE("a forest file gives the same bits on every path", Leaf, ConstantLeaf, LinearLeaf) {
  ByteWriter file;
  write(file, train_extra_trees<Leaf>(toy::sample(toy::ClippedLaws{}, 2000, 1), {.trees = 40}, Serial{}, 1));
  const auto forest = load<Forest<4, 2, Leaf>>(std::span(file.bytes()));  // 40 trees: of two registers' width and rest
  const auto in_place = view<Forest<4, 2, Leaf>>(file.bytes());
  const Trees& trees = forest.raw();
  const auto points = toy::sample(toy::ClippedLaws{}, 17 * 18 / 2 + 300, 2);
  std::vector<std::uint32_t> leaves(forest.trees());
  std::vector<unsigned char> cache(8U << 20U);  // walked to drive the forest out of the nearer caches
  int differences = 0;
  Eigen::Index first = 0;
  const auto check_batch = [&](Eigen::Index size) {
    typename Forest<4, 2, Leaf>::BatchOutput batch;
    typename Forest<4, 2, Leaf>::BatchOutput batch_in_place;
    forest.predict(points.inputs.middleCols(first, size), batch);
    in_place.predict(points.inputs.middleCols(first, size), batch_in_place);
    for (Eigen::Index i = 0; i < size; ++i) {
      const Eigen::Matrix<float, 4, 1> x = points.inputs.col(first + i);
      const Vec<4> wide = x.template cast<double>();
      const Vec<2> expected = walk(forest, x);
      if (i == 0) {
        for (std::size_t line = 0; line < cache.size(); line += 64) ++cache[line];
      }
      const Vec<2> one = forest.predict(wide);  // the first one cold; by SIMD where the machine has it
      Vec<2> portable = Vec<2>::Zero();
      forest.leaf_indices(wide, leaves);
      for (const std::uint32_t leaf : leaves) {
        const std::uint32_t payload = trees.nodes[leaf].payload();
        Leaf::add(trees.parameters.data() + payload * trees.leaf_parameters, x.data(), 4, 2, portable.data());
      }
      portable *= 1.0 / static_cast<double>(forest.trees());
      differences += one != expected || portable != expected || batch.col(i) != expected ||
                             batch_in_place.col(i) != expected || in_place.predict(wide) != expected
                         ? 1
                         : 0;
    }
    first += size;
  };
  for (Eigen::Index size = 1; size <= 17; ++size) check_batch(size);
  check_batch(300);  // in blocks, where small batches go one by one
  CHECK(differences == 0);
}

TEST_CASE_TEMPLATE("the spread is the mean and the standard deviation over the trees", Leaf, ConstantLeaf, LinearLeaf) {
  for (const int trees : {1, 9, 100}) {
    CAPTURE(trees);
    const auto samples = toy::sample(toy::ClippedLaws{}, 300, 1);
    const auto forest = train_extra_trees<Leaf>(samples, {.trees = trees, .min_leaf = 10}, Serial{}, 1);
    const Forest<Eigen::Dynamic, Eigen::Dynamic, Leaf> dynamic(forest.raw());
    for (Eigen::Index i = 0; i < 20; ++i) {
      const Vec<4> x = samples.inputs.col(i).template cast<double>();
      Eigen::Matrix2Xd each(2, trees);
      for (int t = 0; t < trees; ++t) {
        Trees one = forest.raw();
        one.roots = {forest.raw().roots[static_cast<std::size_t>(t)]};
        each.col(t) = Forest<4, 2, Leaf>(one).predict(x);
      }
      const Vec<2> mean = each.rowwise().mean();
      const Vec<2> deviation = (each.colwise() - mean).rowwise().squaredNorm().cwiseSqrt() / std::sqrt(trees);
      const MeanAndDeviation<2> spread = forest.predict_with_deviation(x);
      CHECK(spread.mean == forest.predict(x));
      CHECK((spread.deviation - deviation).norm() < 1e-12);
      CHECK((trees == 1) == (spread.deviation == Vec<2>::Zero()));
      CHECK(dynamic.predict_with_deviation(x).mean == spread.mean);
      CHECK(dynamic.predict_with_deviation(x).deviation == spread.deviation);
    }
  }
}

TEST_CASE("the spread is larger where the forest has seen nothing for long") {
  Dataset<1, 1> samples;
  samples.inputs.resize(1, 200);
  samples.outputs.resize(1, 200);
  for (Eigen::Index i = 0; i < 200; ++i) {  // a wide gap from -0.5 to 0.5
    const double x = (i < 100 ? -1.0 : 0.5) + 0.005 * static_cast<double>(i % 100);
    samples.inputs(0, i) = static_cast<float>(x);
    samples.outputs(0, i) = x;
  }
  const auto forest = train_extra_trees(samples, {.trees = 50, .min_leaf = 3}, Serial{}, 1);
  const double known = forest.predict_with_deviation(Vec<1>(0.75)).deviation[0];
  CHECK(forest.predict_with_deviation(Vec<1>(0.0)).deviation[0] > 10 * known);
}

TEST_CASE("leaf indices name the leaf of each tree") {
  const auto samples = toy::sample(toy::Cliff{}, 500, 1);
  for (const int trees : {1, 8, 9, 70}) {
    const auto forest = train_extra_trees(samples, {.trees = trees, .min_leaf = 5}, Serial{}, 1);
    const auto& raw = forest.raw();
    std::vector<std::uint32_t> leaves(forest.trees());
    for (Eigen::Index i = 0; i < 50; ++i) {
      const Vec<5> x = samples.inputs.col(i).cast<double>();
      forest.leaf_indices(x, leaves);
      double sum = 0;
      for (std::size_t t = 0; t < leaves.size(); ++t) {
        REQUIRE(leaves[t] < raw.nodes.size());
        REQUIRE(raw.nodes[leaves[t]].is_leaf());
        CHECK(leaves[t] >= raw.roots[t]);
        if (t + 1 < leaves.size()) CHECK(leaves[t] < raw.roots[t + 1]);
        sum += static_cast<double>(std::bit_cast<float>(raw.nodes[leaves[t]].payload()));
      }
      CHECK(sum * (1.0 / trees) == forest.predict(x)[0]);
    }
    leaves.push_back(0);
    CHECK_THROWS_WITH_AS(forest.leaf_indices(Vec<5>::Zero(), leaves), doctest::Contains("trees, but room for"),
                         ForestError);
  }
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

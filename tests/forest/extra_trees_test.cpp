#include "surefoot/forest/extra_trees.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stop_token>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/fraction_of_variance_unexplained.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

// Samples still to be filled in, all of weight 1.
template <int Inputs, int Outputs>
Dataset<Inputs, Outputs> room_for(Eigen::Index count) {
  return {Eigen::Matrix<float, Inputs, Eigen::Dynamic>(Inputs, count),
          Eigen::Matrix<double, Outputs, Eigen::Dynamic>(Outputs, count), Eigen::VectorXd::Ones(count)};
}

// For each input the number of trees whose root tests it.
template <int Inputs, int Outputs>
std::vector<int> root_inputs(const Forest<Inputs, Outputs>& forest) {
  std::vector<int> counts(static_cast<std::size_t>(forest.inputs()), 0);
  for (const std::uint32_t root : forest.raw().roots) {
    ++counts[static_cast<std::size_t>(forest.raw().nodes[root].input())];
  }
  return counts;
}

// The number of samples in each leaf of tree `t`, and the depth of the deepest leaf.
struct Shape {
  std::vector<int> leaf_counts;
  int depth = 0;
};

template <class F, int I, int O>
Shape shape_of(const F& forest, std::size_t t, const Dataset<I, O>& samples) {
  const Trees& trees = forest.raw();
  std::vector<int> visits(trees.nodes.size(), 0);
  Shape shape;
  for (Eigen::Index i = 0; i < samples.inputs.cols(); ++i) {
    std::size_t at = trees.roots[t];
    int depth = 0;
    for (; !trees.nodes[at].is_leaf(); ++depth) {
      const Node node = trees.nodes[at];
      at += node.distance() + (samples.inputs(node.input(), i) > node.threshold() ? 1U : 0U);
    }
    ++visits[at];
    shape.depth = std::max(shape.depth, depth);
  }
  for (const int count : visits) {
    if (count > 0) shape.leaf_counts.push_back(count);
  }
  return shape;
}

TEST_CASE("forests learn, linear leaves better than constant ones on linear pieces") {
  const auto train = toy::sample(toy::ClippedLaws{}, 4000, 1);
  const auto test = toy::sample(toy::ClippedLaws{}, 2000, 2);
  const double constant = toy::explained(train_extra_trees(train, {}, Threads{}, 1), test);
  const double linear = toy::explained(train_extra_trees<LinearLeaf>(train, {.min_leaf = 15}, Threads{}, 1), test);
  const double by_variance =
      toy::explained(train_extra_trees<LinearLeaf>(train, {.min_leaf = 15, .model_score = false}, Threads{}, 1), test);
  CHECK(constant > 0.95);
  CHECK(linear > 0.985);
  CHECK(1 - linear < 0.5 * (1 - constant));
  CHECK(1 - linear < 0.8 * (1 - by_variance));
}

TEST_CASE("a cliff and an input without influence do not hinder a forest") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 4000, 1), {}, Threads{}, 1);
  CHECK(toy::explained(forest, toy::sample(toy::Cliff{}, 2000, 2)) > 0.93);
}

TEST_CASE("more samples and more trees learn better") {
  const auto test = toy::sample(toy::Cliff{}, 2000, 9);
  auto score = [&](Eigen::Index samples, int trees) {
    return toy::explained(train_extra_trees(toy::sample(toy::Cliff{}, samples, 1, 0.3), {.trees = trees}, Threads{}, 1),
                          test);
  };
  CHECK(score(4000, 10) > score(400, 10) + 0.02);
  CHECK(score(1000, 20) > score(1000, 1) + 0.02);
}

TEST_CASE_TEMPLATE("a leaf of one sample gives its output back", Leaf, ConstantLeaf, LinearLeaf) {
  const auto samples = toy::sample(toy::Cliff{}, 300, 1);
  const auto forest = train_extra_trees<Leaf>(samples, {.trees = 1, .min_leaf = 1}, Serial{}, 1);
  CHECK(forest.leaves() == 300);
  for (Eigen::Index i = 0; i < 300; ++i) {
    const double y = forest.predict(samples.inputs.col(i).cast<double>())[0];
    CHECK(y == static_cast<double>(static_cast<float>(samples.outputs(0, i))));
  }
}

TEST_CASE_TEMPLATE("the forest does not depend on the number of threads", Leaf, ConstantLeaf, LinearLeaf) {
  const auto samples = toy::sample(toy::ClippedLaws{}, 1500, 1, 0.1);
  for (const bool bootstrap : {false, true}) {
    const ExtraTreesOptions options{.trees = 10, .min_leaf = 8, .bootstrap = bootstrap};
    const auto forest = train_extra_trees<Leaf>(samples, options, Serial{}, 7);
    for (const std::size_t threads : {1U, 2U, 4U}) {
      CHECK(train_extra_trees<Leaf>(samples, options, Threads(threads), 7) == forest);
    }
    CHECK_FALSE(train_extra_trees<Leaf>(samples, options, Serial{}, 8) == forest);
  }
}

TEST_CASE("limits on leaves, depth and samples per leaf are kept") {
  const auto samples = toy::sample(toy::Cliff{}, 2000, 1, 0.1);
  for (const ThresholdRule rule : {ThresholdRule::uniform, ThresholdRule::balanced}) {
    const auto full = train_extra_trees(samples, {.trees = 3, .min_leaf = 7, .threshold_rule = rule}, Serial{}, 1);
    const auto shallow = train_extra_trees(samples, {.trees = 3, .max_depth = 5, .threshold_rule = rule}, Serial{}, 1);
    const auto few = train_extra_trees(samples, {.trees = 3, .max_leaves = 40, .threshold_rule = rule}, Serial{}, 1);
    CHECK(few.leaves() == 3 * 40);
    for (std::size_t t = 0; t < 3; ++t) {
      const Shape shape = shape_of(full, t, samples);
      CHECK(*std::min_element(shape.leaf_counts.begin(), shape.leaf_counts.end()) >= 7);
      CHECK(*std::max_element(shape.leaf_counts.begin(), shape.leaf_counts.end()) < 2 * 7);  // else it would be split
      CHECK(shape_of(shallow, t, samples).depth == 5);
    }
  }
}

TEST_CASE("splits scored on some samples are nearly as good, and leave as many samples in every leaf") {
  const auto samples = toy::sample(toy::Cliff{}, 8000, 1, 0.1);
  const auto test = toy::sample(toy::Cliff{}, 2000, 2);
  ExtraTreesOptions options{.trees = 4, .min_leaf = 40};
  const auto on_all = train_extra_trees<LinearLeaf>(samples, options, Serial{}, 1);
  options.split_samples = 100;
  const auto on_some = train_extra_trees<LinearLeaf>(samples, options, Serial{}, 1);
  CHECK_FALSE(on_some == on_all);
  CHECK(1 - toy::explained(on_some, test) < 1.2 * (1 - toy::explained(on_all, test)));
  for (std::size_t t = 0; t < 4; ++t) {
    const Shape shape = shape_of(on_some, t, samples);
    CHECK(*std::min_element(shape.leaf_counts.begin(), shape.leaf_counts.end()) >= 40);
  }
  options.split_samples = 8000;
  CHECK(train_extra_trees<LinearLeaf>(samples, options, Serial{}, 1) == on_all);
}

TEST_CASE("leaves are spent where they pay most") {
  const auto samples = toy::sample(toy::Cliff{}, 3000, 1);
  const auto test = toy::sample(toy::Cliff{}, 1000, 2);
  const auto best_first = train_extra_trees(samples, {.max_leaves = 64}, Threads{}, 1);
  const auto evenly = train_extra_trees(samples, {.max_depth = 6}, Threads{}, 1);  // at most 64 leaves too
  CHECK(1 - toy::explained(best_first, test) < 0.95 * (1 - toy::explained(evenly, test)));
}

TEST_CASE("a sample of weight w counts as w samples") {
  // Two values at every place: the weighted mean is known.
  auto samples = room_for<1, 1>(400);
  for (Eigen::Index i = 0; i < 400; ++i) {
    const Eigen::Index place = i / 40;
    samples.inputs(0, i) = static_cast<float>(place);
    samples.outputs(0, i) = static_cast<double>(place) + (i % 2 == 0 ? 1.0 : 0.0);
    samples.weights[i] = i % 2 == 0 ? 3.0 : 1.0;
  }
  const auto forest = train_extra_trees(samples, {}, Serial{}, 1);
  for (int place = 0; place < 10; ++place) {
    CHECK(forest.predict(Vec<1>(place))[0] == doctest::Approx(place + 0.75));
  }
}

TEST_CASE_TEMPLATE("a sample of weight 2 teaches what the sample twice would", Leaf, ConstantLeaf, LinearLeaf) {
  auto weighted = toy::sample(toy::ClippedLaws{}, 600, 1, 0.2);
  auto copied = weighted;
  copied.inputs.conservativeResize(Eigen::NoChange, 800);
  copied.outputs.conservativeResize(Eigen::NoChange, 800);
  copied.inputs.rightCols(200) = weighted.inputs.leftCols(200);
  copied.outputs.rightCols(200) = weighted.outputs.leftCols(200);
  const ExtraTreesOptions options{.trees = 4, .min_leaf = 1, .max_leaves = 12, .ridge = 0};  // nothing counts samples
  const auto without = train_extra_trees<Leaf>(weighted, options, Serial{}, 1);
  weighted.weights.setOnes(600);
  weighted.weights.head(200).setConstant(2);
  const auto by_weight = train_extra_trees<Leaf>(weighted, options, Serial{}, 1);
  const auto by_copies = train_extra_trees<Leaf>(copied, options, Serial{}, 1);
  double difference = 0;
  double influence = 0;
  for (Eigen::Index i = 0; i < 600; ++i) {
    const Vec<4> x = weighted.inputs.col(i).template cast<double>();
    difference = std::max(difference, (by_weight.predict(x) - by_copies.predict(x)).norm());
    influence = std::max(influence, (by_weight.predict(x) - without.predict(x)).norm());
  }
  CHECK(difference < 1e-4);
  CHECK(influence > 0.01);
}

TEST_CASE("weights count for what an output's variance is, too") {
  // Two outputs with one step each; samples of hardly any weight blow the first one's variance up.
  auto samples = room_for<2, 2>(1000);
  Rng rng(2);
  for (Eigen::Index i = 0; i < 1000; ++i) {
    samples.inputs.col(i) << static_cast<float>(rng.uniform()), static_cast<float>(rng.uniform());
    samples.outputs.col(i) << (samples.inputs(0, i) > 0.5F ? 1.2 : 0), (samples.inputs(1, i) > 0.5F ? 1 : 0);
    if (i % 100 == 0) {
      samples.outputs(0, i) = rng.normal() * 100;
      samples.weights[i] = 1e-9;
    }
  }
  const auto forest = train_extra_trees(samples, {.trees = 200, .max_leaves = 2}, Serial{}, 1);
  const int of_first = root_inputs(forest)[0];
  CHECK(of_first > 70);  // both outputs count alike: 100 expected
  CHECK(of_first < 130);
}

TEST_CASE("splits follow the weights") {
  // Half of the samples have nearly no weight; a tree of two leaves must cut where the others have their step.
  auto samples = room_for<1, 1>(400);
  Rng rng(5);
  for (Eigen::Index i = 0; i < 400; ++i) {
    const double x = rng.uniform(0, 1);
    const bool heavy = i % 2 == 0;
    samples.inputs(0, i) = static_cast<float>(x);
    samples.outputs(0, i) = heavy ? (x > 0.2 ? 1 : 0) : (x > 0.8 ? 5 : 0);
    samples.weights[i] = heavy ? 1 : 1e-4;
  }
  const auto forest = train_extra_trees(samples, {.trees = 50, .max_leaves = 12}, Serial{}, 1);
  CHECK(std::abs(forest.predict(Vec<1>(0.1))[0] - 0) < 0.3);
  CHECK(std::abs(forest.predict(Vec<1>(0.5))[0] - 1) < 0.3);
  CHECK(std::abs(forest.predict(Vec<1>(0.9))[0] - 1) < 0.5);  // 3 without weights
}

TEST_CASE("several outputs count alike, whatever their units") {
  auto samples = toy::sample(toy::ClippedLaws{}, 2000, 1);
  const auto test = toy::sample(toy::ClippedLaws{}, 1000, 2);
  const auto forest = train_extra_trees(samples, {}, Threads{}, 1);
  samples.outputs.row(1) *= 1024;
  const auto scaled = train_extra_trees(samples, {}, Threads{}, 1);
  int differences = 0;
  for (Eigen::Index i = 0; i < 1000; ++i) {
    const Vec<4> x = test.inputs.col(i).cast<double>();
    const Vec<2> a = forest.predict(x);
    const Vec<2> b = scaled.predict(x);
    if (std::abs(a[0] - b[0]) > 1e-6 || std::abs(a[1] - b[1] / 1024) > 1e-6) ++differences;
  }
  CHECK(differences == 0);
}

TEST_CASE("bootstrap leaves out some samples of each tree") {
  const auto samples = toy::sample(toy::Cliff{}, 500, 1, 0.5);
  const auto all = train_extra_trees(samples, {.trees = 1, .min_leaf = 1}, Serial{}, 1);
  const auto drawn = train_extra_trees(samples, {.trees = 1, .min_leaf = 1, .bootstrap = true}, Serial{}, 1);
  CHECK(all.leaves() == 500);
  CHECK(drawn.leaves() > 500 * 0.55);  // 1 - 1/e of the samples are drawn at least once
  CHECK(drawn.leaves() < 500 * 0.71);
}

TEST_CASE("with few candidates the inputs are drawn at random") {
  const auto samples = toy::sample(toy::Cliff{}, 500, 1);
  const auto roots = [&](int candidates) {
    const ExtraTreesOptions options{.trees = 200, .candidates = candidates, .max_depth = 1};
    return root_inputs(train_extra_trees(samples, options, Serial{}, 1));
  };
  const std::vector<int> one = roots(1);
  CHECK(*std::min_element(one.begin(), one.end()) > 15);  // 40 expected for each
  const std::vector<int> all = roots(0);
  CHECK(all[3] + all[0] > 150);  // the cliff, and the sine
  CHECK(all[4] < 10);            // the input without influence
}

TEST_CASE_TEMPLATE("a lone tree is better the more thresholds are drawn", Leaf, ConstantLeaf, LinearLeaf) {
  const auto samples = toy::sample(toy::Cliff{}, 4000, 1);
  const auto test = toy::sample(toy::Cliff{}, 2000, 2);
  for (const ThresholdRule rule : {ThresholdRule::uniform, ThresholdRule::balanced}) {
    const auto error = [&](int draws) {
      double sum = 0;
      for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const ExtraTreesOptions options{
            .trees = 1, .draws = draws, .min_leaf = 10, .max_leaves = 40, .threshold_rule = rule};
        sum += fraction_of_variance_unexplained(train_extra_trees<Leaf>(samples, options, Serial{}, seed), test);
      }
      return sum;
    };
    const double one = error(1);
    const double many = error(16);
    CAPTURE(one);
    CHECK(many < 0.8 * one);
  }
}

TEST_CASE("of the thresholds drawn the best is taken") {
  // The step lies where one random threshold hardly ever falls.
  auto samples = room_for<1, 1>(1000);
  for (Eigen::Index i = 0; i < 1000; ++i) {
    samples.inputs(0, i) = static_cast<float>(i);
    samples.outputs(0, i) = i < 300 ? 0 : 1;
  }
  const auto forest = train_extra_trees(samples, {.trees = 20, .draws = 100, .max_depth = 1}, Serial{}, 1);
  double distance = 0;
  for (const std::uint32_t root : forest.raw().roots) {
    distance += std::abs(static_cast<double>(forest.raw().nodes[root].threshold()) - 299.5) / 20;
  }
  CHECK(distance < 15);  // the nearest of 100: about 5; of one about 290
}

TEST_CASE("data that cannot be split gives one leaf") {
  Dataset<2, 1> samples;
  samples.inputs = Eigen::Matrix<float, 2, Eigen::Dynamic>::Constant(2, 50, 3.0F);
  samples.outputs = Eigen::Matrix<double, 1, Eigen::Dynamic>::LinSpaced(50, 0, 49);
  for (const ThresholdRule rule : {ThresholdRule::uniform, ThresholdRule::balanced}) {
    const auto forest = train_extra_trees(samples, {.trees = 2, .min_leaf = 1, .threshold_rule = rule}, Serial{}, 1);
    CHECK(forest.leaves() == 2);
    CHECK(forest.predict(Vec<2>(3, 3))[0] == 24.5);
  }
  samples.inputs.row(0) = Eigen::Matrix<float, 1, Eigen::Dynamic>::LinSpaced(50, 0, 1);
  samples.outputs.setConstant(7);
  CHECK(train_extra_trees(samples, {.trees = 1, .min_leaf = 1}, Serial{}, 1).leaves() == 1);
  const auto linear = train_extra_trees<LinearLeaf>(samples, {.trees = 1, .min_leaf = 1}, Serial{}, 1);
  CHECK(linear.predict(Vec<2>(5, 5))[0] == 7);
}

TEST_CASE("inputs of any size are split") {
  // Neighbouring floats, huge spans and outliers must neither hang nor leave a child empty.
  constexpr float huge = std::numeric_limits<float>::max();
  for (const bool linear : {false, true}) {
    Dataset<3, 1> samples;
    samples.inputs.resize(3, 200);
    samples.outputs.resize(1, 200);
    Rng rng(1);
    float next = 1;
    for (Eigen::Index i = 0; i < 200; ++i) {
      samples.inputs(0, i) = next = std::nextafter(next, 2.0F);
      samples.inputs(1, i) = i % 2 == 0 ? -huge : huge;
      samples.inputs(2, i) = i == 0 ? 1e30F : static_cast<float>(rng.uniform());
      samples.outputs(0, i) = rng.normal();
    }
    const ExtraTreesOptions options{.trees = 5, .min_leaf = 1};
    const std::size_t leaves = linear ? train_extra_trees<LinearLeaf>(samples, options, Serial{}, 1).leaves()
                                      : train_extra_trees(samples, options, Serial{}, 1).leaves();
    CHECK(leaves == 5 * 200);
  }
}

TEST_CASE("wrong options and samples are named") {
  const auto samples = toy::sample(toy::Cliff{}, 20, 1);
  auto train = [&](const ExtraTreesOptions& options) { train_extra_trees(samples, options, Serial{}, 1); };
  CHECK_THROWS_WITH_AS(train({.trees = 0}), doctest::Contains("trees"), ForestError);
  CHECK_THROWS_WITH_AS(train({.candidates = -1}), doctest::Contains("candidates"), ForestError);
  CHECK_THROWS_WITH_AS(train({.draws = 0}), doctest::Contains("draws"), ForestError);
  CHECK_THROWS_WITH_AS(train({.min_leaf = 0}), doctest::Contains("min_leaf"), ForestError);
  CHECK_THROWS_WITH_AS(train({.max_depth = -1}), doctest::Contains("max_depth"), ForestError);
  CHECK_THROWS_WITH_AS(train({.max_leaves = -1}), doctest::Contains("max_leaves"), ForestError);
  CHECK_THROWS_WITH_AS(train({.ridge = -1}), doctest::Contains("ridge"), ForestError);
  CHECK_THROWS_AS(train_extra_trees(Dataset<2, 2>{}, {}, Serial{}, 1), ForestError);
  Dataset<Eigen::Dynamic, 1> wide;
  wide.inputs = Eigen::MatrixXf::Zero(256, 3);
  wide.outputs.resize(1, 3);
  wide.outputs.setZero();
  CHECK_THROWS_WITH_AS(train_extra_trees(wide, {}, Serial{}, 1), doctest::Contains("255"), ForestError);
}

TEST_CASE("training can be stopped") {
  std::stop_source source;
  source.request_stop();
  const auto samples = toy::sample(toy::Cliff{}, 20, 1);
  CHECK_THROWS_AS(train_extra_trees(samples, {}, Serial{}, 1, source.get_token()), Error);
}

// A user's own leaf: the middle one of the samples' outputs.
struct MedianLeaf {
  static constexpr std::uint32_t tag = 1001;
  static constexpr std::size_t parameters(int, int outputs) { return static_cast<std::size_t>(outputs); }
  static void fit(const LeafSamples& samples, const LeafOptions&, std::span<float> parameters) {
    for (std::size_t o = 0; o < parameters.size(); ++o) {
      std::vector<float> values;
      for (std::size_t i = 0; i < samples.count(); ++i) values.push_back(samples.output(i)[o]);
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      parameters[o] = *middle;
    }
  }
  static void add(const float* parameters, const float*, int, int outputs, double* sum) {
    for (int o = 0; o < outputs; ++o) sum[o] += static_cast<double>(parameters[o]);
  }
};
static_assert(LeafModel<MedianLeaf>);

TEST_CASE("a user's own leaf is trained and used like the others") {
  auto samples = toy::sample(toy::Cliff{}, 3000, 1);
  for (Eigen::Index i = 0; i < 3000; i += 10) samples.outputs(0, i) = 1000;  // outliers that a median ignores
  const auto forest = train_extra_trees<MedianLeaf>(samples, {.min_leaf = 25}, Threads{}, 1);
  CHECK(toy::explained(forest, toy::sample(toy::Cliff{}, 500, 2)) > 0.5);
}

}  // namespace
}  // namespace surefoot

#include "surefoot/forest/training_report.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

/// Root of the mean squared error, per output.
template <class F, int I, int O>
Eigen::VectorXd rmse(const F& forest, const Dataset<I, O>& test) {
  Eigen::Matrix<double, O, Eigen::Dynamic> predicted;
  forest.predict(test.inputs, predicted);
  return (predicted - test.outputs).array().square().rowwise().mean().sqrt();
}

TEST_CASE_TEMPLATE("the out-of-bag error is about that on other samples", Leaf, ConstantLeaf, LinearLeaf) {
  const double noise = 0.3;
  const auto train = toy::sample(toy::ClippedLaws{}, 3000, 1, noise);
  const auto test = toy::sample(toy::ClippedLaws{}, 3000, 2, noise);
  const ExtraTreesOptions options{.trees = 50, .min_leaf = 8, .bootstrap = true};
  const auto result = train_with_report<Leaf>(train, options, Threads{}, 1);
  REQUIRE(result.out_of_bag);
  const OutOfBagError& error = *result.out_of_bag;
  const Eigen::VectorXd on_others = rmse(result.forest, test);
  const Eigen::VectorXd on_same = rmse(result.forest, train);
  CHECK(error.covered == 3000);
  for (Eigen::Index o = 0; o < 2; ++o) {
    CHECK(error.rmse[o] == doctest::Approx(on_others[o]).epsilon(0.05));
    CHECK(error.rmse[o] > 1.1 * on_same[o]);
    const double variance = (train.outputs.row(o).array() - train.outputs.row(o).mean()).square().mean();
    CHECK(error.explained[o] == doctest::Approx(1 - error.rmse[o] * error.rmse[o] / variance));
  }
}

TEST_CASE("a tree is tested on the samples it did not draw") {
  const auto samples = toy::sample(toy::Cliff{}, 4000, 1, 1.0);
  const ExtraTreesOptions options{.trees = 1, .min_leaf = 1, .bootstrap = true};
  const auto result = train_with_report(samples, options, Serial{}, 1);
  CHECK(std::abs(static_cast<double>(result.out_of_bag->covered) / 4000 - std::exp(-1)) < 0.02);
  // Leaves of one sample: no error on samples drawn, and that of two noises on the others.
  CHECK(result.out_of_bag->rmse[0] > std::sqrt(2.0));
  const double error_on_all = rmse(result.forest, samples)[0];
  const double share = static_cast<double>(result.out_of_bag->covered) / 4000;
  CHECK(error_on_all == doctest::Approx(result.out_of_bag->rmse[0] * std::sqrt(share)).epsilon(1e-3));
}

TEST_CASE("the out-of-bag error counts samples by their weights") {
  auto samples = toy::sample(toy::Cliff{}, 2000, 1);
  samples.weights.resize(2000);
  Rng rng(3);
  for (Eigen::Index i = 0; i < 2000; ++i) {
    const bool noisy = i % 2 == 0;
    samples.weights[i] = noisy ? 1e-4 : 1;
    if (noisy) samples.outputs(0, i) += 10 * rng.normal();
  }
  const ExtraTreesOptions options{.bootstrap = true};
  const double weighted = train_with_report(samples, options, Threads{}, 1).out_of_bag->rmse[0];
  samples.weights.setOnes();
  const double alike = train_with_report(samples, options, Threads{}, 1).out_of_bag->rmse[0];
  CHECK(weighted < 2);  // leaves of noisy samples only: few
  CHECK(alike > 5);
}

TEST_CASE("the report does not change the forest, nor do threads the report") {
  const auto samples = toy::sample(toy::Cliff{}, 2500, 1, 0.1);
  for (const bool bootstrap : {false, true}) {
    const ExtraTreesOptions options{.trees = 6, .bootstrap = bootstrap};
    const auto result = train_with_report(samples, options, Serial{}, 5);
    const auto by_threads = train_with_report(samples, options, Threads(3), 5);
    CHECK(result.forest == train_extra_trees(samples, options, Serial{}, 5));
    CHECK(result.importance == by_threads.importance);
    REQUIRE(result.out_of_bag.has_value() == bootstrap);
    if (!bootstrap) continue;
    CHECK(result.out_of_bag->rmse == by_threads.out_of_bag->rmse);
    CHECK(result.out_of_bag->explained == by_threads.out_of_bag->explained);
    CHECK(result.out_of_bag->covered == by_threads.out_of_bag->covered);
  }
}

TEST_CASE_TEMPLATE("importance tells inputs with influence from those without", Leaf, ConstantLeaf, LinearLeaf) {
  const auto samples = toy::sample(toy::Cliff{}, 3000, 1);
  const auto result = train_with_report<Leaf>(samples, {.min_leaf = 20}, Threads{}, 1);
  const Eigen::VectorXd& share = result.importance;
  CHECK(share.sum() == doctest::Approx(1));
  CHECK(share.minCoeff() >= 0);
  CHECK(share[3] > 0.4);  // the cliff
  CHECK(share[4] < 0.03);
  CHECK(share.head(4).minCoeff() > 1.5 * share[4]);
}

TEST_CASE("importance adds the gains of all splits up") {
  // One split of one of two inputs: all of the importance.
  Dataset<2, 1> samples;
  samples.inputs.resize(2, 100);
  samples.outputs.resize(1, 100);
  Rng rng(1);
  for (Eigen::Index i = 0; i < 100; ++i) {
    samples.inputs.col(i) << static_cast<float>(rng.uniform()), 1.0F;
    samples.outputs(0, i) = rng.normal();
  }
  const auto result = train_with_report(samples, {.trees = 3}, Serial{}, 1);
  CHECK(result.importance[0] == 1);
  CHECK(result.importance[1] == 0);
  samples.outputs.setConstant(4);
  CHECK(train_with_report(samples, {.trees = 3}, Serial{}, 1).importance.isZero(0));
}

TEST_CASE("an output that does not vary explains nothing and has no error") {
  auto samples = toy::sample(toy::ClippedLaws{}, 500, 1);
  samples.outputs.row(1).setConstant(1e6);
  const auto result = train_with_report(samples, {.bootstrap = true}, Serial{}, 1);
  CHECK(result.out_of_bag->explained[0] > 0.5);
  CHECK(result.out_of_bag->explained[1] == 0);
  CHECK(result.out_of_bag->rmse[1] == 0);
}

}  // namespace
}  // namespace surefoot

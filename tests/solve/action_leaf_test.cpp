#include "surefoot/solve/action_leaf.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "surefoot/core/rng.hpp"

namespace surefoot {
namespace {

/// What a leaf learns from 100 samples of action(x) and says at x = 0.5; one input in [0, 1), one output.
template <class Leaf = ActionLeaf>
double learnt(const std::function<double(double x, Rng& rng)>& action) {
  Rng rng(1);
  std::vector<float> records;
  for (int i = 0; i < 100; ++i) {
    const double x = rng.uniform();
    records.push_back(static_cast<float>(x));
    records.push_back(static_cast<float>(action(x, rng)));
  }
  std::vector<float> parameters(Leaf::parameters(1, 1));
  Leaf::fit(LeafSamples(records.data(), 100, 2, 1, 1, false), {}, parameters);
  const float x = 0.5F;
  double sum = 0;
  Leaf::add(parameters.data(), &x, 1, 1, &sum);
  return sum;
}

TEST_CASE("a leaf of one opinion is a linear leaf") {
  CHECK(learnt([](double x, Rng&) { return 2 * x - 1; }) == doctest::Approx(0).epsilon(0.05));
  CHECK(learnt([](double, Rng& rng) { return 0.3 * rng.uniform(-1, 1); }) == doctest::Approx(0).epsilon(0.1));
}

TEST_CASE("a leaf of two opinions takes the one of more samples") {
  CHECK(learnt([](double, Rng& rng) { return rng.uniform() < 0.6 ? 1.0 : -1.0; }) == doctest::Approx(1));
  CHECK(learnt([](double, Rng& rng) { return rng.uniform() < 0.4 ? 0.9 : -0.8; }) == doctest::Approx(-0.8));
}

TEST_CASE("by actions a step within a leaf is one of its sides, by distances a slope between them") {
  const auto right = [](double x, Rng&) { return x < 0.4 ? -1.0 : 1.0; };
  const auto left = [](double x, Rng&) { return x < 0.6 ? -1.0 : 1.0; };
  CHECK(learnt<LikeActionLeaf>(right) == doctest::Approx(1).epsilon(0.01));
  CHECK(learnt<LikeActionLeaf>(left) == doctest::Approx(-1).epsilon(0.01));
  CHECK(learnt(right) < 0.6);
  CHECK(learnt(left) > -0.6);
}

TEST_CASE("by distances steep feedback with noise is one opinion, by actions a part of it") {
  const auto steep = [](double x, Rng& rng) { return 2 * x - 1 + 0.4 * rng.normal(); };
  CHECK(learnt(steep) == doctest::Approx(0).epsilon(0.15));
  CHECK(std::abs(learnt<LikeActionLeaf>(steep)) > 0.15);
}

TEST_CASE("a few samples far off are noise and no second opinion") {
  const double action = learnt([](double, Rng& rng) { return rng.uniform() < 0.05 ? 1.0 : 0.0; });
  CHECK(action > 0);
  CHECK(action < 0.2);
}

}  // namespace
}  // namespace surefoot

#include "surefoot/forest/short_floats.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <cstdint>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

TEST_CASE("short floats are the nearest ones of 11 significant bits") {
  for (const float exact : {0.0F, 1.0F, -2.5F, 0.1F, -3.14159F, 1e-30F, 6e29F}) {
    const float rounded = detail::shortened(exact);
    CHECK(detail::is_short(std::bit_cast<std::uint32_t>(rounded)));
    CHECK(std::abs(rounded - exact) <= std::abs(exact) / 2048);
  }
  CHECK(detail::shortened(1.0F + 1.0F / 2048) == 1.0F);  // half way: to the even one
  CHECK(detail::shortened(1.0F + 3.0F / 2048) == 1.0F + 1.0F / 512);
}

template <class F>
void check_close(const F& forest) {
  const F close = with_short_floats(forest);
  CHECK(close != forest);
  CHECK(with_short_floats(close) == close);
  Rng rng(5);
  int far = 0;  // right at a threshold an input may go to the neighbouring leaf
  for (int i = 0; i < 1000; ++i) {
    Eigen::VectorXd x(forest.inputs());
    for (double& value : x) value = rng.uniform(-1.5, 1.5);
    const auto exact = forest.predict(x);
    if ((exact - close.predict(x)).norm() > 0.002 * (1 + exact.norm())) ++far;
  }
  CHECK(far < 50);
}

TEST_CASE("a forest of short floats predicts nearly the same") {
  check_close(train_extra_trees(toy::sample(toy::Cliff{}, 3000, 1), {.trees = 20}, Serial{}, 1));
  check_close(train_extra_trees<LinearLeaf>(toy::sample(toy::ClippedLaws{}, 3000, 1), {.trees = 20}, Serial{}, 1));
}

}  // namespace
}  // namespace surefoot

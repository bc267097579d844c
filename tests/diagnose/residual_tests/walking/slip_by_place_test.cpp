// Floor that takes a share of the steps made on it.
#include "surefoot/diagnose/residual_tests/walking/slip_by_place.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/core/executor.hpp"
#include "tests/support/fitted_walk.hpp"

namespace surefoot::diagnosis {
namespace {

template <class Change>
Comparison slip_of(Change&& change, std::uint64_t seed, const Parallel& parallel = serially()) {
  const toys::FittedWalk walk = toys::fitted_walk(change, seed, parallel);
  return slip_by_place(walk.bound, walk.hypothesis, walk.problem, walk.split.folds, parallel, seed);
}

const auto patch = [](Pose2 moved, Pose2 at) {
  const double hold = std::hypot(at.x - 0.1, at.y) < 0.1 ? 0.4 : 1;
  return Pose2{hold * moved.x, moved.y, hold * moved.angle};
};

TEST_CASE("no place is slippery on a floor that is not") {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Comparison found = slip_of([](Pose2 moved, Pose2) { return moved; }, seed);
    alarms += found.gain > 0.03 && found.p_value < 0.005 ? 1 : 0;
  }
  CHECK(alarms == 0);
}

TEST_CASE("a gain that is off by the same share everywhere is a parameter, no place") {
  const Comparison found = slip_of([](Pose2 moved, Pose2) { return Pose2{0.5 * moved.x, moved.y, moved.angle}; }, 4);
  CHECK_FALSE((found.gain > 0.03 && found.p_value < 0.005));
}

TEST_CASE("a slippery patch is found") {
  const Comparison found = slip_of(patch, 3);
  CHECK(found.gain > 0.03);
  CHECK(found.p_value < 0.005);
}

TEST_CASE("slip by place: the same bits on any number of threads") {
  const Threads two(2);
  const Parallel shared = [&](std::size_t count, const std::function<void(std::size_t)>& job) { two.run(count, job); };
  CHECK(slip_of(patch, 5).gain == slip_of(patch, 5, shared).gain);
}

TEST_CASE("the odds of a sum, if its terms may as well have the other sign") {
  CHECK(sign_flip_p_value({1, 1, 1, 1, 1, 1, 1, 1, 1, 1}) == doctest::Approx(1.0 / 1024).epsilon(0.9));
  CHECK(sign_flip_p_value({1, -1, 2, -2}) > 0.3);
  CHECK(sign_flip_p_value({}) == 1);
}

}  // namespace
}  // namespace surefoot::diagnosis

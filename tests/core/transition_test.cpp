#include "surefoot/core/transition.hpp"

#include <doctest/doctest.h>

#include "surefoot/core/vec.hpp"

namespace surefoot {
namespace {

struct Drift {
  Vec<1> operator()(const Vec<1>& position, const Vec<1>& speed, Rng& rng) const {
    return position + speed + 0.01 * Vec<1>(rng.normal());
  }
};
struct WithoutNoise {
  Vec<1> operator()(const Vec<1>& position, const Vec<1>& speed) const { return position + speed; }
};
struct Changing {
  Vec<1> operator()(const Vec<1>& position, const Vec<1>&, Rng&) { return position; }
};

TEST_CASE("a transition model is a const call with state, action and Rng") {
  static_assert(TransitionModel<Drift, Vec<1>, Vec<1>>);
  static_assert(!TransitionModel<Drift, Vec<2>, Vec<1>>);
  static_assert(!TransitionModel<WithoutNoise, Vec<1>, Vec<1>>);
  static_assert(!TransitionModel<Changing, Vec<1>, Vec<1>>);
  const auto lambda = [](const Vec<1>& state, const Vec<1>& action, Rng&) -> Vec<1> { return state + action; };
  static_assert(TransitionModel<decltype(lambda), Vec<1>, Vec<1>>);
  Rng rng(1);
  CHECK(lambda(Vec<1>(1.0), Vec<1>(2.0), rng)[0] == 3);
}

}  // namespace
}  // namespace surefoot

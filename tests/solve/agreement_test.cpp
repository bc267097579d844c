#include "surefoot/solve/agreement.hpp"

#include <doctest/doctest.h>

#include <vector>

namespace surefoot {
namespace {

const Vec<2> reach(0.5, 1);

TEST_CASE("where all agree the action is their mean") {
  const std::vector<double> proposals{0, 1, 0.2, 2, 0.4, 1.5};
  CHECK(agreed_action<2>(proposals, reach).isApprox(Vec<2>(0.2, 1.5)));
}

TEST_CASE("of two opinions the larger one counts, and never the middle") {
  const std::vector<double> proposals{-1, 1, 0.9, -1, 1, -1, -0.9, 1, 0.95, -1};
  const Vec<2> action = agreed_action<2>(proposals, reach);
  CHECK(action[0] == doctest::Approx(0.95));
  CHECK(action[1] == doctest::Approx(-1));
}

TEST_CASE("rounding does not decide a tied vote") {
  std::vector<double> proposals{1, 1, -1, 1, 1, 1, -1, 1};  // of four trees
  const Vec<2> action = agreed_action<2>(proposals, reach);
  CHECK(action == Vec<2>(1, 1));
  for (double& number : proposals) {
    number *= 1 + 1e-15;
    CHECK(agreed_action<2>(proposals, reach).isApprox(action, 1e-14));
  }
}

TEST_CASE("an outlier is left out") {
  const Vec<1> action = agreed_action<1>(std::vector<double>{0.1, 0.2, -1, 0.3}, Vec<1>(0.5));
  CHECK(action[0] == doctest::Approx(0.2));
}

TEST_CASE("a dimension without width does not part opinions") {
  const Vec<2> action = agreed_action<2>(std::vector<double>{1, 0, -1, 0, 1, 0}, Vec<2>(0.5, 0));
  CHECK(action == Vec<2>(1, 0));
}

TEST_CASE("a lone tree is its own opinion") {
  CHECK(agreed_action<2>(std::vector<double>{0.3, -4}, reach) == Vec<2>(0.3, -4));
}

}  // namespace
}  // namespace surefoot

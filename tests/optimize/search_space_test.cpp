#include "surefoot/optimize/search_space.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "surefoot/core/box.hpp"
#include "surefoot/core/rng.hpp"

namespace surefoot {
namespace {

using Eigen::VectorXd;

Box<Eigen::Dynamic> example_box() { return {VectorXd{{-2, 10, 0}}, VectorXd{{4, 10.5, 1000}}}; }

TEST_CASE("without a box both coordinates are the same") {
  const SearchSpace space(std::nullopt);
  const VectorXd x{{-1e9, 3}};
  CHECK(space.to_search(x) == x);
  CHECK(space.to_user(x) == x);
}

TEST_CASE("every point of the box, faces and corners included, comes back from the search's coordinates") {
  const Box<Eigen::Dynamic> box = example_box();
  const SearchSpace space(box);
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    VectorXd x = box.sample(rng);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double where = rng.uniform();
      if (where < 0.2) x[k] = box.low()[k];
      if (where > 0.8) x[k] = box.high()[k];
    }
    const VectorXd back = space.to_user(space.to_search(x));
    for (Eigen::Index k = 0; k < 3; ++k) CHECK(back[k] == doctest::Approx(x[k]).epsilon(1e-12).scale(box.width()[k]));
  }
}

TEST_CASE("every point of the search's coordinates, however far, lands in the box") {
  const Box<Eigen::Dynamic> box = example_box();
  const SearchSpace space(box);
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const double scale = std::pow(10.0, rng.uniform(-3, 9));
    const VectorXd y{{scale * rng.normal(), scale * rng.normal(), scale * rng.normal()}};
    CHECK(box.contains(space.to_user(y)));
  }
}

TEST_CASE("the map is continuous with a continuous slope, which is 0 at the faces and 1 inside") {
  const SearchSpace space(Box<Eigen::Dynamic>{VectorXd{{0}}, VectorXd{{1}}});
  const auto at = [&](double y) { return space.to_user(VectorXd{{y}})[0]; };
  const auto slope = [&](double y) { return (at(y + 1e-6) - at(y - 1e-6)) / 2e-6; };
  for (double y = -4; y < 4; y += 0.003) CHECK(std::abs(slope(y + 1e-4) - slope(y)) < 0.01);
  CHECK(slope(0.5) == doctest::Approx(1));
  const double low_face = space.to_search(VectorXd{{0}})[0], high_face = space.to_search(VectorXd{{1}})[0];
  CHECK(std::abs(slope(low_face)) < 1e-4);
  CHECK(std::abs(slope(high_face)) < 1e-4);
  CHECK(high_face - low_face == doctest::Approx(1.1));
}

TEST_CASE("dimensions without width are left out of the search and keep their value") {
  const SearchSpace space(Box<Eigen::Dynamic>{VectorXd{{0, 7, 0}}, VectorXd{{1, 7, 1}}});
  CHECK(space.to_search(VectorXd{{0.5, 7, 0.25}}).isApprox(VectorXd{{0.5, 0.25}}));
  CHECK(space.to_user(VectorXd{{0.5, 0.25}}).isApprox(VectorXd{{0.5, 7, 0.25}}));
}

TEST_CASE("a box without any width and a start outside the box are refused") {
  CHECK_THROWS_AS(SearchSpace(Box<Eigen::Dynamic>{VectorXd{{1, 2}}, VectorXd{{1, 2}}}), OptimizeError);
  const SearchSpace space(example_box());
  CHECK_THROWS_AS(space.to_search(VectorXd{{5, 10, 0}}), OptimizeError);
  CHECK_THROWS_AS(space.to_search(VectorXd{{0, 10}}), OptimizeError);
  CHECK_THROWS_AS(space.to_search(VectorXd{{0, std::nan(""), 0}}), OptimizeError);
}

}  // namespace
}  // namespace surefoot

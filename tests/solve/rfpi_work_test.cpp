#include "surefoot/solve/rfpi_work.hpp"

#include <doctest/doctest.h>

namespace surefoot {
namespace {

TEST_CASE("work costs what its parts cost") {
  RfpiWork work{.steps = 1'000'000};
  CHECK(work.seconds({.step_ns = 80}) == doctest::Approx(0.08));
  CHECK(work.seconds({.step_ns = 800}) == doctest::Approx(0.8));
  const double steps = work.seconds({});
  work.lookups = 1'000'000;
  const double lookups = work.seconds({});
  CHECK(lookups > steps);
  work.fits = 1'000'000;
  CHECK(work.seconds({}) > lookups);
}

TEST_CASE(
    "fitting costs as many trees, a little more than as many samples, and more for affine scores and more draws") {
  const ExtraTreesOptions plain{.trees = 2, .min_leaf = 20, .model_score = false};
  const auto work = [](int samples, ExtraTreesOptions options) {
    return static_cast<double>(detail::fit_work(static_cast<std::size_t>(samples), 11, 3, options));
  };
  ExtraTreesOptions more = plain;
  more.trees = 4;
  CHECK(work(10'000, more) == doctest::Approx(2 * work(10'000, plain)));
  CHECK(work(20'000, plain) > 2 * work(10'000, plain));
  CHECK(work(20'000, plain) < 2.2 * work(10'000, plain));
  ExtraTreesOptions affine = plain;
  affine.model_score = true;
  CHECK(work(10'000, affine) > work(10'000, plain));
  more = affine;
  more.draws = 4;
  CHECK(work(10'000, more) > 2 * work(10'000, affine));
  more = affine;
  more.candidates = 3;
  CHECK(work(10'000, more) < work(10'000, affine));
}

TEST_CASE("scores on some samples, and few leaves, cost less") {
  const ExtraTreesOptions all{.trees = 2, .min_leaf = 30};
  ExtraTreesOptions some = all, few = all;
  some.split_samples = 300;
  few.max_leaves = 10;
  CHECK(detail::fit_work(100'000, 11, 3, some) < detail::fit_work(100'000, 11, 3, all));
  CHECK(detail::fit_work(100'000, 11, 3, few) < detail::fit_work(100'000, 11, 3, all));
  CHECK(detail::fit_work(100, 11, 3, some) == detail::fit_work(100, 11, 3, all));
}

}  // namespace
}  // namespace surefoot

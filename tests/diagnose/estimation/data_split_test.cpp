// Splits into training, folds and held-out recordings.
#include "surefoot/diagnose/estimation/data_split.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace surefoot::diagnosis {
namespace {

std::vector<Recording> named(std::size_t count) {
  std::vector<Recording> recordings(count);
  for (std::size_t i = 0; i < count; ++i) {
    recordings[i].name = 'r';
    recordings[i].name += std::to_string(i);
  }
  return recordings;
}

TEST_CASE("folds partition the training recordings, and with those held out they are all recordings, once each") {
  for (std::size_t count = 2; count < 14; ++count) {
    for (const double share : {0.01, 0.25, 0.9, 1.0}) {
      const RecordingSplit split = split_recordings(named(count), {}, share, 4, count);
      CHECK_FALSE(split.cross_fitted);
      CHECK_FALSE(split.held_out.empty());
      CHECK_FALSE(split.training.empty());
      CHECK(split.folds.size() == (split.training.size() <= 6 ? split.training.size() : 4));
      std::vector<std::size_t> dealt;
      for (const auto& fold : split.folds) {
        CHECK_FALSE(fold.empty());
        CHECK(fold.size() <= split.folds.front().size());
        dealt.insert(dealt.end(), fold.begin(), fold.end());
      }
      std::sort(dealt.begin(), dealt.end());
      CHECK(dealt == split.training);
      dealt.insert(dealt.end(), split.held_out.begin(), split.held_out.end());
      std::sort(dealt.begin(), dealt.end());
      std::vector<std::size_t> every(count);
      std::iota(every.begin(), every.end(), std::size_t{0});
      CHECK(dealt == every);
    }
  }
}

TEST_CASE("with a share of 0 every recording is for the fit, and held out once with its fold") {
  for (std::size_t count = 2; count < 14; ++count) {
    const RecordingSplit split = split_recordings(named(count), {}, 0, 4, count);
    std::vector<std::size_t> every(count), dealt;
    std::iota(every.begin(), every.end(), std::size_t{0});
    CHECK(split.cross_fitted);
    CHECK(split.training == every);
    CHECK(split.held_out == every);
    CHECK(split.folds.size() >= 2);  // so that there is always something to fit to
    for (const auto& fold : split.folds) dealt.insert(dealt.end(), fold.begin(), fold.end());
    std::sort(dealt.begin(), dealt.end());
    CHECK(dealt == every);
  }
}

TEST_CASE("the share of held-out recordings is the one asked for") {
  CHECK(split_recordings(named(20), {}, 0.25, 4, 1).held_out.size() == 5);
  CHECK(split_recordings(named(3), {}, 0.25, 4, 1).held_out.size() == 1);
}

TEST_CASE("recordings that are named are held out, and never in a fold") {
  const RecordingSplit split = split_recordings(named(6), {"r4", "r1"}, 0.9, 3, 1);
  CHECK(split.held_out == std::vector<std::size_t>{1, 4});
  CHECK(split.training == std::vector<std::size_t>{0, 2, 3, 5});
  CHECK_FALSE(split.cross_fitted);
  CHECK(split_recordings(named(6), {"r4"}, 0, 3, 1).held_out == std::vector<std::size_t>{4});
}

TEST_CASE("names that do not exist, and tests that leave nothing, are refused") {
  CHECK_THROWS_WITH_AS(split_recordings(named(3), {"r7"}, 0.25, 3, 1),
                       "the held-out recording 'r7' is not among the recordings", DiagnoseError);
  CHECK_THROWS_AS(split_recordings(named(2), {"r0", "r1"}, 0.25, 3, 1), DiagnoseError);
}

TEST_CASE("the same seed gives the same split, another seed another one") {
  std::set<std::vector<std::size_t>> tests;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RecordingSplit one = split_recordings(named(12), {}, 0.25, 4, seed);
    CHECK(one.folds == split_recordings(named(12), {}, 0.25, 4, seed).folds);
    tests.insert(one.held_out);
  }
  CHECK(tests.size() > 10);
}

}  // namespace
}  // namespace surefoot::diagnosis

#include "surefoot/motion/compare.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/previous_command_correction.hpp"
#include "tests/support/walks.hpp"

using surefoot::FullLinearCorrection;
using surefoot::ProportionalCorrection;
using surefoot::SimpleLinearCorrection;
using surefoot::WalkSequence;

TEST_CASE("models are compared on sequences they were not fitted to, and the simplest good one is chosen") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 40, 4));
  const auto scores = surefoot::compare_models<ProportionalCorrection, SimpleLinearCorrection, FullLinearCorrection,
                                               surefoot::PreviousCommandCorrection>(walks, {}, surefoot::Threads(2), 1);
  REQUIRE(scores.size() == 5);
  CHECK(scores[0].name == "commands as they are");
  CHECK(scores[0].position > scores[1].position);
  CHECK(scores[1].position > scores[3].position);
  CHECK(scores[3].chosen);
  CHECK(scores[3].name == "full linear");
  const auto straight = toys::final_poses(toys::walks(surefoot::ProportionalCorrection(), toys::paper_noise(), 40, 5));
  const auto plain =
      surefoot::compare_models<ProportionalCorrection, FullLinearCorrection>(straight, {}, surefoot::Serial{}, 1);
  CHECK(plain[0].chosen);
}

TEST_CASE("models named by their types and models as values get the same scores") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 12, 6));
  const std::vector<surefoot::AnyMotionModel> models{ProportionalCorrection(), SimpleLinearCorrection()};
  const auto typed =
      surefoot::compare_models<ProportionalCorrection, SimpleLinearCorrection>(walks, {}, surefoot::Serial{}, 1);
  const auto values =
      surefoot::compare_models(std::span<const surefoot::AnyMotionModel>(models), walks, {}, surefoot::Serial{}, 1);
  REQUIRE(values.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(values[i].name == typed[i].name);
    CHECK(values[i].position == typed[i].position);
  }
}

TEST_CASE("a model that ends where the robot ended has no error, and one sequence no standard error") {
  const auto walks = toys::walks(toys::paper_walk(), surefoot::MotionNoise(), 1, 7);
  const surefoot::ModelEvaluation score = surefoot::evaluate_on(toys::paper_walk(), walks);
  CHECK(score.name == "full linear");
  CHECK(score.parameters == 12);
  CHECK(score.position < 1e-9);
  CHECK(std::isinf(score.position_error));
  CHECK(surefoot::evaluate_commands(walks).parameters == 0);
  CHECK(surefoot::evaluate_commands(walks).position > 0.01);
}

TEST_CASE("wrong options of a comparison are refused by name") {
  const auto walks = toys::walks(toys::paper_walk(), toys::paper_noise(), 2, 8, 3);
  const auto compare = [&](const surefoot::CompareOptions& options) {
    surefoot::compare_models<ProportionalCorrection>(walks, options, surefoot::Serial{}, 1);
  };
  CHECK_THROWS_WITH_AS(compare({.folds = 1}), "CompareOptions: folds must be at least 2, got 1", surefoot::MotionError);
  CHECK_THROWS_AS(compare({.tolerance = -1}), surefoot::MotionError);
}

#include "surefoot/motion/plan/learning_curve.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "surefoot/motion/linear_correction.hpp"
#include "tests/support/walks.hpp"

using surefoot::FullLinearCorrection;
using surefoot::ProportionalCorrection;
using surefoot::SimpleLinearCorrection;
using surefoot::WalkSequence;

TEST_CASE("with few sequences the small model wins, with many the full one, by the published fit") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 25, 1));
  surefoot::LearningCurveOptions options{.counts = {1, 2, 20}, .repetitions = 16};
  options.predictor.method = surefoot::FitMethod::published;
  const std::span<const WalkSequence> all(walks);
  const auto small = surefoot::learning_curve<ProportionalCorrection>(all, options, surefoot::Threads(2), 1);
  const auto full = surefoot::learning_curve<FullLinearCorrection>(all, options, surefoot::Threads(2), 1);
  CHECK(small.position[0] < full.position[0]);
  CHECK(small.position[1] < full.position[1]);
  CHECK(full.position[2] < small.position[2]);
  CHECK(full.position_half_width[2] > 0);
  CHECK(full.coefficients_deviation(1, 2) < full.coefficients_deviation(1, 0));
  CHECK(full.coefficients(1, 2) == doctest::Approx(1.3).epsilon(0.3));
}

TEST_CASE("a curve does not depend on the number of threads") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 10, 2));
  const surefoot::LearningCurveOptions options{.counts = {2, 4}, .repetitions = 5};
  const std::span<const WalkSequence> all(walks);
  const auto one = surefoot::learning_curve<SimpleLinearCorrection>(all, options, surefoot::Serial{}, 1);
  const auto three = surefoot::learning_curve<SimpleLinearCorrection>(all, options, surefoot::Threads(3), 1);
  CHECK((one.position == three.position).all());
  CHECK(one.coefficients == three.coefficients);
}

TEST_CASE("a curve whose splits are partly known computes the others alone, to the same result") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 10, 2));
  surefoot::LearningCurveOptions options{.counts = {2, 4}, .repetitions = 4};
  std::map<std::size_t, std::vector<surefoot::SplitResult>> kept;
  options.on_split = [&](std::size_t repetition, const auto& split) { kept[repetition] = split; };
  const std::span<const WalkSequence> all(walks);
  const auto whole = surefoot::learning_curve<SimpleLinearCorrection>(all, options, surefoot::Threads(2), 1);
  REQUIRE(kept.size() == 4);
  const auto before = kept;
  kept.clear();
  options.known = [&](std::size_t repetition) -> std::optional<std::vector<surefoot::SplitResult>> {
    if (repetition == 1) return std::nullopt;
    return before.at(repetition);
  };
  const auto resumed = surefoot::learning_curve<SimpleLinearCorrection>(all, options, surefoot::Threads(2), 1);
  CHECK((whole.position == resumed.position).all());
  CHECK(whole.coefficients == resumed.coefficients);
  REQUIRE(kept.size() == 1);
  CHECK(kept.begin()->first == 1);
}

TEST_CASE("a curve that is asked for no counts has them all, and reports its repetitions") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 8, 6));
  std::vector<std::size_t> reported;
  surefoot::LearningCurveOptions options{.repetitions = 4};
  options.on_progress = [&](std::size_t done) { reported.push_back(done); };
  const std::span<const WalkSequence> all(walks);
  const auto curve = surefoot::learning_curve<ProportionalCorrection>(all, options, surefoot::Threads(2), 1);
  CHECK(curve.counts == std::vector<std::size_t>{1, 2, 3});  // 5 are held out
  CHECK(curve.position.size() == 3);
  CHECK(reported == std::vector<std::size_t>{1, 2, 3, 4});
  for (const std::size_t bad : {0U, 4U}) {
    options.counts = {1, bad};
    CHECK_THROWS_WITH_AS(surefoot::learning_curve<ProportionalCorrection>(all, options, surefoot::Serial{}, 1),
                         "LearningCurveOptions: counts must be from 1 to all but the held-out sequences",
                         surefoot::MotionError);
  }
}

TEST_CASE("too few sequences for a curve are refused") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 5, 3));
  CHECK_THROWS_WITH_AS(
      surefoot::learning_curve<SimpleLinearCorrection>(std::span<const WalkSequence>(walks), {}, surefoot::Serial{}, 1),
      "learning_curve: 5 sequence(s) are too few to keep 5 for validation", surefoot::MotionError);
}

TEST_CASE("what more sequences bring follows from the curve") {
  surefoot::LearningCurve curve;
  curve.counts = {1, 2, 5, 10, 15, 20};
  curve.position.resize(6);
  for (int i = 0; i < 6; ++i) {
    curve.position[i] = std::sqrt(0.04 + 0.2 / static_cast<double>(curve.counts[static_cast<std::size_t>(i)]));
  }
  const auto more = more_sequences(curve, 20);
  CHECK(more.limit == doctest::Approx(0.2));
  CHECK(more.now == doctest::Approx(std::sqrt(0.05)));
  // (1.05 * 0.2)^2 = 0.04 + 0.2 / n at n = 48.8
  CHECK(more.worthwhile == 29);
}

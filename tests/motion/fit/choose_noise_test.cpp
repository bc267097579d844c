#include "surefoot/motion/fit/choose_noise.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <span>

#include "surefoot/motion/calibrate.hpp"
#include "tests/support/walks.hpp"

using surefoot::MotionNoise;
using surefoot::NoiseGrowth;
using surefoot::NoiseShape;
using surefoot::Vec;

namespace {

MotionNoise noise_of(NoiseShape shape, NoiseGrowth growth) {
  MotionNoise noise{.shape = shape};
  if (growth == NoiseGrowth::constant) noise.constant = {0.012, 0.01, 0.05};
  if (growth == NoiseGrowth::with_speed) noise.per_speed = {0.015, 0.012, 0.06};
  if (growth == NoiseGrowth::with_speed_and_acceleration) {
    noise.constant = {0.004, 0.004, 0.015};
    noise.per_speed = {0.01, 0.01, 0.04};
    noise.per_acceleration = {0.006, 0.006, 0.03};
  }
  return noise;
}

}  // namespace

TEST_CASE("the noise that walks were made with is chosen and found again") {
  for (const NoiseShape shape : {NoiseShape::uniform, NoiseShape::gaussian}) {
    for (const NoiseGrowth growth :
         {NoiseGrowth::constant, NoiseGrowth::with_speed, NoiseGrowth::with_speed_and_acceleration}) {
      CAPTURE(name_of(shape));
      CAPTURE(name_of(growth));
      const MotionNoise truth = noise_of(shape, growth);
      const auto walks = toys::walks(toys::paper_walk(), truth, 60, 7);
      surefoot::CalibrationOptions options;
      options.model.accuracy = {.position = 0.0005, .heading = 0.001};
      const auto calibration = surefoot::calibrate<surefoot::FullLinearCorrection>(walks, options);
      const auto choice = surefoot::choose_noise(calibration.model, std::span<const surefoot::WalkSequence>(walks),
                                                 {.fit = {.accuracy = options.model.accuracy}}, surefoot::Threads(2));
      CHECK(choice.shape_known);
      const auto& chosen = choice.candidates[choice.chosen];
      CHECK(chosen.shape == shape);
      CHECK(chosen.growth == growth);
      const Vec<3> usual{0.04, 0.02, 0.2};
      CHECK(chosen.noise.deviation(usual, Vec<3>::Zero()).isApprox(truth.deviation(usual, Vec<3>::Zero()), 0.1));
    }
  }
}

TEST_CASE("final poses show the size of the noise but not its shape") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 200, 8));
  const auto choice = surefoot::choose_noise(toys::paper_walk(), std::span<const surefoot::WalkSequence>(walks), {},
                                             surefoot::Threads(2));
  CHECK_FALSE(choice.shape_known);
  CHECK(choice.candidates.size() == 3);
  const double turn = 0.0873 / std::sqrt(3.0);
  CHECK(choice.noise().deviation({0.04, 0, 0.2}, {0.02, 0, 0.1})[2] == doctest::Approx(turn).epsilon(0.25));
}

TEST_CASE("the choice does not depend on the number of threads") {
  const auto walks = toys::walks(toys::paper_walk(), toys::paper_noise(), 12, 9);
  const std::span<const surefoot::WalkSequence> all(walks);
  const auto one = surefoot::choose_noise(toys::paper_walk(), all, {}, surefoot::Serial{});
  const auto three = surefoot::choose_noise(toys::paper_walk(), all, {}, surefoot::Threads(3));
  REQUIRE(one.candidates.size() == three.candidates.size());
  for (std::size_t i = 0; i < one.candidates.size(); ++i)
    CHECK(one.candidates[i].heldout == three.candidates[i].heldout);
}

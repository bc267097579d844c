#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/fit/choose_noise.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/fit/noise_fit.hpp"
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

TEST_CASE("noise has the deviation it says, in either shape") {
  for (const NoiseShape shape : {NoiseShape::uniform, NoiseShape::gaussian}) {
    const MotionNoise noise{
        .shape = shape, .constant = {0.01, 0.02, 0.03}, .per_speed = {0.02, 0, 0}, .per_acceleration = {0, 0.1, 0}};
    const Vec<3> commands{0.08, 0, 0}, previous{0, 0, 0};
    CHECK(noise.deviation(commands, previous).isApprox(Vec<3>{0.03, 0.12, 0.03}));
    surefoot::Rng rng(1);
    Vec<3> squares = Vec<3>::Zero();
    for (int i = 0; i < 20'000; ++i) squares += noise.sample(commands, previous, rng).cwiseAbs2();
    CHECK((squares / 20'000).cwiseSqrt().isApprox(noise.deviation(commands, previous), 0.03));
  }
}

TEST_CASE("noise is named in words") {
  CHECK(name_of(NoiseShape::uniform) == "uniform");
  CHECK(name_of(NoiseShape::gaussian) == "gaussian");
  CHECK(name_of(NoiseGrowth::constant) == "constant");
  CHECK(name_of(NoiseGrowth::with_speed) == "proportional to speed");
  CHECK(name_of(NoiseGrowth::with_speed_and_acceleration) == "linear in speed and acceleration");
}

TEST_CASE("the density of noise seen through blur is one, from hardly any noise to hardly any blur") {
  constexpr int count = 40'000;
  for (const NoiseShape shape : {NoiseShape::uniform, NoiseShape::gaussian}) {
    for (const double sigma : {1e-6, 1e-4, 0.003, 0.01, 0.2}) {
      CAPTURE(sigma);
      constexpr double blur = 0.01;
      const double end = 3 * sigma + 8 * blur, width = end / count;
      surefoot::detail::ComponentDeviations all{Eigen::ArrayXd::LinSpaced(count, width / 2, end - width / 2),
                                                Eigen::ArrayXd::Zero(count), Eigen::ArrayXd::Zero(count), blur};
      if (shape == NoiseShape::gaussian) all.size *= 3;  // of longer tails
      const double part = shape == NoiseShape::gaussian ? 3 * width : width;
      const Eigen::ArrayXd density = all.log_density(shape, Vec<3>(sigma, 0, 0)).exp();
      CHECK(2 * part * density.sum() == doctest::Approx(1).epsilon(1e-4));
      for (Eigen::Index i = 1; i < count; ++i) REQUIRE(density[i] <= density[i - 1] * (1 + 1e-9));
    }
  }
}

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

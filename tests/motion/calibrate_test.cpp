#include "surefoot/motion/calibrate.hpp"

#include <doctest/doctest.h>

#include "surefoot/motion/linear_correction.hpp"
#include "tests/support/walks.hpp"

using surefoot::FullLinearCorrection;
using surefoot::Vec;

TEST_CASE("standard errors say how far coefficients are off, with poses after every cycle") {
  surefoot::CalibrationOptions options;
  options.model.accuracy = {.position = 0.0005, .heading = 0.001};
  int within_two = 0, all = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto walks = toys::walks(toys::paper_walk(), toys::paper_noise(), 25, 100 + seed);
    const auto calibration = surefoot::calibrate<FullLinearCorrection>(walks, options);
    const Vec<12> off =
        (calibration.model.parameters() - toys::paper_walk().parameters()).cwiseQuotient(calibration.standard_errors());
    within_two += static_cast<int>((off.array().abs() < 1.96).count());
    all += 12;
    CHECK(calibration.noise.constant.isApprox(toys::paper_noise().half_width / std::sqrt(3.0), 0.1));
  }
  // 95 % of 240 coefficients, give or take three deviations (nearly independent ones).
  CHECK(within_two > 0.95 * all - 3 * std::sqrt(0.95 * 0.05 * all));
}

TEST_CASE("25 final poses predict nearly as well as the true walk") {
  const auto judges = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 500, 1));
  const std::span<const surefoot::WalkSequence> all(judges);
  const double commanded = final_pose_error(FullLinearCorrection(), all).position;
  const double truth = final_pose_error(toys::paper_walk(), all).position;
  double sum = 0;
  for (std::uint64_t seed = 0; seed < 9; ++seed) {
    const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 25, 200 + seed));
    sum += final_pose_error(surefoot::calibrate<FullLinearCorrection>(walks).model, all).position / 9;
  }
  CHECK(truth < 0.5 * commanded);
  CHECK(sum < 1.15 * truth);
}

#include "surefoot/motion/fit/predictor.hpp"

#include <doctest/doctest.h>

#include "surefoot/motion/linear_correction.hpp"
#include "tests/support/walks.hpp"

TEST_CASE("a predictor is the model of the method that was asked for") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 10, 1));
  const auto noise = toys::paper_noise().as_motion_noise();
  const surefoot::ProportionalCorrection start;
  surefoot::PredictorOptions options;
  CHECK(surefoot::fit_predictor(start, walks, noise, options, 1).parameters() ==
        surefoot::fit_model<surefoot::ProportionalCorrection>(walks, noise).model.parameters());
  options.method = surefoot::FitMethod::published;
  CHECK(surefoot::fit_predictor(start, walks, noise, options, 1).parameters() ==
        surefoot::published_fit<surefoot::ProportionalCorrection>(walks, {}, surefoot::Serial{}, 1).model.parameters());
}

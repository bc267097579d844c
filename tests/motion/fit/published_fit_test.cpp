#include "surefoot/motion/fit/published_fit.hpp"

#include <doctest/doctest.h>

#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "tests/support/walks.hpp"

using surefoot::FullLinearCorrection;

TEST_CASE("the fitness is the weighted average of two root mean squares") {
  auto walks = toys::walks(surefoot::FullLinearCorrection(), surefoot::UniformNoise{}, 2, 1);
  walks[0].poses.col(24) += surefoot::Vec<3>{0.3, 0.4, 0};
  walks[1].poses(2, 24) += 0.7;
  const std::span<const surefoot::WalkSequence> all(walks);
  const surefoot::PublishedFitOptions options{.heading_tolerance = 0.2, .heading_weight = 0.25};
  CHECK(published_fitness(FullLinearCorrection(), all, options) ==
        doctest::Approx(0.75 * 0.5 / std::sqrt(2) + 0.25 * 0.5 / std::sqrt(2)));
}

TEST_CASE("the published fit and the likelihood agree within their errors on clean data") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 60, 2));
  const surefoot::PublishedFitOptions options{.heading_tolerance = 0};
  const auto published = surefoot::published_fit<FullLinearCorrection>(walks, options, surefoot::Serial{}, 1);
  const auto likelihood = surefoot::calibrate<FullLinearCorrection>(walks);
  const surefoot::Vec<12> apart = published.model.parameters() - likelihood.model.parameters();
  CHECK(apart.cwiseQuotient(likelihood.standard_errors()).lpNorm<Eigen::Infinity>() < 3);
  CHECK(published.error.position <=
        final_pose_error(likelihood.model, std::span<const surefoot::WalkSequence>(walks)).position);
}

TEST_CASE("Gauss-Newton steps end where CMA-ES does, where the readings determine the model") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 40, 3));
  const std::span<const surefoot::WalkSequence> all(walks), few = all.first(4);
  for (const double tolerance : {0.0, 0.1}) {
    surefoot::PublishedFitOptions options{.heading_tolerance = tolerance};
    const auto search = surefoot::published_fit<FullLinearCorrection>(all, options, surefoot::Serial{}, 1);
    options.steps_where_determined = true;
    const auto steps = surefoot::published_fit<FullLinearCorrection>(all, options, surefoot::Serial{}, 1);
    CHECK(steps.fitness == doctest::Approx(search.fitness).epsilon(2e-3));
    CHECK(steps.fitness == doctest::Approx(published_fitness(steps.model, all, options)));
    CHECK(steps.evaluations < 100);
  }
  const surefoot::PublishedFitOptions options{.steps_where_determined = true};  // 12 readings, 12 parameters
  CHECK(surefoot::published_fit<FullLinearCorrection>(few, options, surefoot::Serial{}, 1).evaluations > 500);
}

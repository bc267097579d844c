#include "surefoot/motion/changes/sequence_fit.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/motion/fit/fit_model.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "tests/support/walks.hpp"

namespace {

const surefoot::MotionNoise noise{.constant = {0.01, 0.01, 0.03}};

surefoot::SequenceFit fit(std::span<const surefoot::WalkSequence> walks) {
  const surefoot::AnyMotionModel start = surefoot::FullLinearCorrection();
  return surefoot::fit_sequences(walks, start, noise, toys::exact,
                                 {start.default_parameters(), surefoot::prior_information(start)});
}

}  // namespace

TEST_CASE("a fit by sequences is that of the likelihood, with the same covariance for independent cycles") {
  const auto walks = toys::walks(toys::paper_walk(), noise, 30, 3);
  const auto one = fit(walks);
  const auto other = surefoot::fit_model<surefoot::FullLinearCorrection>(walks, noise, {.accuracy = toys::exact});
  CHECK((one.model.parameters() - other.model.parameters()).norm() < 1e-5);
  const Eigen::MatrixXd covariance = one.covariance(Eigen::MatrixXd::Identity(12, 12));
  CHECK((covariance - other.covariance).norm() < 1e-4 * other.covariance.norm());
}

TEST_CASE("independent cycles spread by 1, an offset of each sequence by much more") {
  auto walks = toys::walks(toys::paper_walk(), noise, 60, 4);
  const auto independent = fit(walks);
  const surefoot::SequenceFit* one[] = {&independent};
  CHECK(surefoot::covariance_inflation(one).trace() / 12 == doctest::Approx(1).epsilon(0.2));
  surefoot::Rng rng(8);
  for (auto& walk : walks) {
    auto robot = toys::paper_walk().parameters();
    robot[4] += 0.008 * rng.normal();  // the drift to the left differs from day to day
    walk = surefoot::simulate_walk(surefoot::FullLinearCorrection::from_parameters(robot), noise, toys::exact, walk, rng);
  }
  const auto drifting = fit(walks);
  const surefoot::SequenceFit* two[] = {&drifting};
  const Eigen::MatrixXd inflation = surefoot::covariance_inflation(two);
  const double honest = std::sqrt(drifting.covariance(inflation)(4, 4));
  CHECK(honest > 2 * std::sqrt(drifting.covariance(Eigen::MatrixXd::Identity(12, 12))(4, 4)));
  CHECK(honest < 2 * 0.008 / std::sqrt(60.0));
}

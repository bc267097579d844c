#include "surefoot/motion/monitor/recursive_update.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <span>
#include <vector>

#include "surefoot/motion/plan/command_plan.hpp"
#include "tests/support/sigmaban_walk.hpp"

using surefoot::MotionError;
using surefoot::Vec;
using surefoot::WalkSequence;

using Tracker = surefoot::MotionTracker;

namespace {

std::vector<WalkSequence> wandering(int sequences, const surefoot::MotionNoise& noise, bool every_pose,
                                    std::uint64_t seed) {
  return sigmaban::walked(sigmaban::model(), noise, surefoot::plan_commands({}, sequences, 25, seed), every_pose, seed);
}

}  // namespace

TEST_CASE("three sequences as a batch and nine one by one come to the batch fit of all, every pose measured") {
  const auto noise = sigmaban::noise(0.2);  // little, so that the walk is nearly linear in its parameters
  const std::vector<WalkSequence> sequences = wandering(12, noise, true, 1);
  const auto batch = surefoot::fit_model<sigmaban::Model>(sequences, noise);
  const auto three = surefoot::fit_model<sigmaban::Model>(std::span(sequences).first(3), noise);
  Tracker tracker = surefoot::track(three.model, three.covariance, noise);
  tracker.forgetting = 1;
  for (const WalkSequence& sequence : std::span(sequences).last(9)) update(tracker, sequence);
  const Vec<12> apart = tracker.model.parameters() - batch.model.parameters();
  CHECK(apart.cwiseQuotient(batch.standard_errors()).lpNorm<Eigen::Infinity>() < 0.3);
  const Vec<12> ratio = tracker.standard_errors().cwiseQuotient(batch.standard_errors());
  CHECK(ratio.minCoeff() > 0.95);
  CHECK(ratio.maxCoeff() < 1.05);
}

TEST_CASE("half of the sequences as a batch and half one by one come to the batch fit of all, final poses only") {
  const auto noise = sigmaban::noise(0.2);
  const std::vector<WalkSequence> sequences = wandering(40, noise, false, 2);
  const auto all = surefoot::fit_model<sigmaban::Model>(sequences, noise);
  const auto half = surefoot::fit_model<sigmaban::Model>(std::span(sequences).first(20), noise);
  Tracker tracker = surefoot::track(half.model, half.covariance, noise);
  tracker.forgetting = 1;
  for (const WalkSequence& sequence : std::span(sequences).last(20)) update(tracker, sequence);
  const Vec<12> apart = tracker.model.parameters() - all.model.parameters();
  CHECK(apart.cwiseQuotient(all.standard_errors()).lpNorm<Eigen::Infinity>() < 0.3);
}

TEST_CASE("the surprise of a robot that walks as calibrated is a chi-square") {
  const auto noise = sigmaban::noise();
  const std::vector<WalkSequence> sequences = wandering(150, noise, true, 3);
  const auto fit = surefoot::fit_model<sigmaban::Model>(std::span(sequences).first(25), noise);
  Tracker tracker = surefoot::track(fit.model, fit.covariance, noise);
  double squared = 0, freedoms = 0;
  for (const WalkSequence& sequence : std::span(sequences).last(125)) {
    const surefoot::Surprise surprise = update(tracker, sequence);
    squared += surprise.squared;
    freedoms += static_cast<double>(surprise.freedoms);
    CHECK(surprise.freedoms == 75);
    CHECK(surprise.deviations() < 5);
  }
  CHECK(squared / freedoms == doctest::Approx(1).epsilon(0.05));
}

TEST_CASE("with forgetting the tracker follows a changed robot, and what is not excited stays within the prior") {
  const auto noise = sigmaban::noise();
  const std::vector<WalkSequence> before = wandering(25, noise, true, 4);
  const auto fit = surefoot::fit_model<sigmaban::Model>(before, noise);
  Tracker tracker = surefoot::track(fit.model, fit.covariance, noise);
  tracker.forgetting = 0.9;
  std::vector<Eigen::Matrix3Xd> plan = surefoot::plan_commands({}, 200, 25, 5);
  for (Eigen::Matrix3Xd& commands : plan) commands.row(1).setZero();  // never sideways again
  for (const WalkSequence& sequence : sigmaban::walked(sigmaban::bent(1, 0.8), noise, plan, true, 5)) {
    update(tracker, sequence);
  }
  CHECK(tracker.model.parameters()[1] == doctest::Approx(0.8 * 1.30).epsilon(0.05));
  // Never below the information of the prior in any direction.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> excess(tracker.information - tracker.floor);
  CHECK(excess.eigenvalues().minCoeff() > -1e-6 * tracker.floor.norm());
  const Vec<12> prior = surefoot::prior_information(sigmaban::model()).diagonal().cwiseSqrt().cwiseInverse();
  CHECK((tracker.standard_errors().array() <= 1.0001 * prior.array()).all());
  CHECK(tracker.standard_errors()[6] > 0.9 * prior[6]);  // dy per dy was forgotten, down to the prior
}

TEST_CASE("what a tracker cannot use is refused") {
  Tracker tracker{.model = sigmaban::Model()};
  tracker.noise = sigmaban::noise();
  CHECK_THROWS_AS(update(tracker, WalkSequence{.name = "1", .commands = {}, .poses = {}}), MotionError);
  tracker.forgetting = 0;
  CHECK_THROWS_AS(update(tracker, wandering(1, sigmaban::noise(), true, 1)[0]), MotionError);
  CHECK_THROWS_AS(surefoot::track(sigmaban::Model(), -Eigen::MatrixXd::Identity(12, 12), sigmaban::noise()),
                  MotionError);
}

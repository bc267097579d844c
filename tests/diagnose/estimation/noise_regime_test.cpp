// Noise that accumulates is told from noise of measurement, and final poses are weighted by what it leaves in them.
#include "surefoot/diagnose/estimation/noise_regime.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/walking_robot.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::WalkingRobot;

std::vector<Recording> walks(bool final_pose_only, int count, std::uint64_t seed) {
  return toys::walk_recordings([](Pose2 moved, Pose2) { return moved; }, final_pose_only, count, seed);
}

Hypothesis with_gains(const BoundSimulator& bound, const Vec<3>& gains) {
  Hypothesis hypothesis = nominal_hypothesis(bound);
  hypothesis.parameters = gains;
  return hypothesis;
}

std::vector<std::size_t> first(std::size_t from, std::size_t to) {
  std::vector<std::size_t> result;
  for (std::size_t i = from; i < to; ++i) result.push_back(i);
  return result;
}

// Walks without noise of the steps, measured with some (5 mm, 20 mrad).
std::vector<Recording> exact_walks(int count) {
  auto recordings = walks(false, count, 3);
  Rng rng(3);
  for (Recording& recording : recordings) {
    recording.outputs = simulate_augmented(WalkingRobot{}, toys::machine({1.2, 0.9, 1.1}), recording).outputs;
    for (Eigen::Index i = 1; i < recording.rows(); ++i) {
      recording.outputs.col(i) += Vec<3>(0.005 * rng.normal(), 0.005 * rng.normal(), 0.02 * rng.normal());
    }
  }
  return recordings;
}

TEST_CASE("steps that are noisy are noise of the process, poses that are noise of the measurement") {
  const BoundSimulator walking = bind_simulator(WalkingRobot{}, walks(false, 20, 1)),
                       measuring = bind_simulator(WalkingRobot{}, exact_walks(20));
  for (const Vec<3>& gains :
       {Vec<3>(1.2, 0.9, 1.1), Vec<3>(1, 1, 1), Vec<3>(1.7, 0.5, 0.6)}) {  // also before these are known
    CHECK(noise_kind(walking, with_gains(walking, gains), first(0, 20)) == NoiseKind::process);
    CHECK(noise_kind(measuring, with_gains(measuring, gains), first(0, 20)) == NoiseKind::measurement);
  }
  const Vec<3> truth(1.2, 0.9, 1.1);
  CHECK(std::abs(step_correlations(walking, with_gains(walking, truth), first(0, 20)).col(0).mean()) < 0.1);
  CHECK(step_correlations(measuring, with_gains(measuring, truth), first(0, 20)).col(0).mean() ==
        doctest::Approx(-0.5).epsilon(0.2));
}

TEST_CASE("a stated process noise says what kind it is") {
  BoundSimulator bound = bind_simulator(WalkingRobot{}, exact_walks(20));
  const Hypothesis hypothesis = with_gains(bound, {1.2, 0.9, 1.1});
  bound.info.outputs[0].process_noise = bound.info.outputs[1].process_noise = 0.01;
  CHECK(noise_kind(bound, hypothesis, first(0, 20)) == NoiseKind::measurement);  // of the third nothing is stated
  bound.info.outputs[2].process_noise = 0.03;
  CHECK(noise_kind(bound, hypothesis, first(0, 20)) == NoiseKind::process);
}

TEST_CASE("steps that differ in turn are not taken for noise of the measurement") {
  for (const int period : {2, 3}) {
    CAPTURE(period);
    auto recordings = exact_walks(20);
    for (Recording& recording : recordings) {
      double turned = 0;
      for (Eigen::Index i = 1; i < recording.rows(); ++i) {
        turned += i % period == 0 ? 0.2 : -0.2 / (period - 1);
        recording.outputs(2, i) += turned;
      }
    }
    const BoundSimulator limping = bind_simulator(WalkingRobot{}, recordings);
    CHECK(noise_kind(limping, with_gains(limping, {1.2, 0.9, 1.1}), first(0, 20)) == NoiseKind::process);
  }
}

TEST_CASE("walks of which only the end was measured are recognized, and machines with rates never are walks") {
  const BoundSimulator ends = bind_simulator(WalkingRobot{}, walks(true, 5, 1));
  CHECK(only_final_pose(ends));
  CHECK(noise_kind(ends, nominal_hypothesis(ends), first(0, 5)) == NoiseKind::final_pose);
  auto mixed = walks(true, 5, 1);
  mixed[2] = walks(false, 1, 1)[0];
  CHECK_FALSE(only_final_pose(bind_simulator(WalkingRobot{}, mixed)));
  const BoundSimulator tank = bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 50)});
  CHECK(noise_kind(tank, nominal_hypothesis(tank), {0}) == NoiseKind::measurement);
}

TEST_CASE("whitened final poses have unit variance and no correlation, also those that were not looked at") {
  const BoundSimulator bound = bind_simulator(WalkingRobot{}, walks(true, 300, 7));
  const Hypothesis truth = with_gains(bound, {1.2, 0.9, 1.1});
  const auto whitening = final_pose_whitening(bound, truth, first(0, 150), {});
  REQUIRE(whitening.size() == 300);
  for (const auto& some : {first(0, 150), first(150, 300)}) {
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(), raw = covariance;
    for (const std::size_t r : some) {
      const std::vector<Cell> cells = cells_of(bound.recordings[r]);
      const SimulatedRun run = simulate(bound, truth, r, {});
      const Eigen::VectorXd white =
          weighted_residuals(bound, r, run, cells, {.sigma = Vec<3>(1, 1, 1), .whitening = whitening});
      const Eigen::VectorXd off = raw_residuals(bound, r, run, cells);
      REQUIRE(white.size() == 3);
      covariance += white * white.transpose() / 150;
      raw += off * off.transpose() / 150;
    }
    CHECK(covariance.diagonal().minCoeff() > 0.7);
    CHECK(covariance.diagonal().maxCoeff() < 1.4);
    CHECK(covariance.trace() / 3 == doctest::Approx(1).epsilon(0.15));
    covariance.diagonal().setZero();
    CHECK(covariance.cwiseAbs().maxCoeff() < 0.3);
    CHECK(raw(2, 2) == doctest::Approx(25 * 1e-4 + 4e-4).epsilon(0.3));  // 25 steps of 10 mrad and 20 mrad of tape
  }
}

TEST_CASE("a longer walk counts less") {
  auto recordings = walks(true, 60, 8);
  for (std::size_t r = 0; r < 30; ++r) {  // stands still after five steps, and there is measured
    Recording& recording = recordings[r];
    const Eigen::VectorXd end = walks(false, 60, 8)[r].outputs.col(5);
    recording = part_of(recording, 0, 6, recording.initial, recording.initial_scale);
    recording.outputs.col(5) = end;
  }
  const BoundSimulator bound = bind_simulator(WalkingRobot{}, recordings);
  const auto whitening = final_pose_whitening(bound, with_gains(bound, {1.2, 0.9, 1.1}), first(0, 60), {});
  CHECK(whitening[0].norm() > 1.3 * whitening[59].norm());
}

TEST_CASE("recordings with a few readings each decide nothing for themselves") {
  const auto with_readings = [](Eigen::Index kept) {
    std::vector<Recording> recordings;
    for (int r = 0; r < 3; ++r) {
      Recording one = toys::tank_recording(r, 100);
      one.outputs = simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}, {}), one).outputs;
      one.outputs.leftCols(100 - kept).fill(std::nan(""));
      recordings.push_back(std::move(one));
    }
    return bind_simulator(toys::LeakyTank{}, recordings);
  };
  CHECK(few_readings(with_readings(3), {0, 1, 2}));
  CHECK_FALSE(few_readings(with_readings(60), {0, 1, 2}));
  CHECK(few_readings(with_readings(60), {}));
}

}  // namespace
}  // namespace surefoot::diagnosis

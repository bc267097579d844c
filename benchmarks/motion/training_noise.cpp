// What it is worth to know the noise of a walk. The robot: the published walk, its noise proportional to its speed and
// as large as the published one at half of full speed. It is calibrated from 60 sequences of random commands; then two
// policies are trained for the calibrated walk, one with the calibrated noise, one with the constant noise that was
// published, and both play on the robot.
//   training_noise [SEED [BUDGET]]    BUDGET: of each training, seconds of one nominal core (60)
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "examples/sigmaban/approach/approach.hpp"
#include "examples/sigmaban/approach/seed_states.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/solve/rfpi.hpp"
#include "tests/support/walks.hpp"

namespace {

using Problem = sigmaban::ApproachWith<surefoot::FullLinearCorrection, surefoot::MotionNoise>;

constexpr surefoot::PoseAccuracy accuracy{.position = 0.005, .heading = 0.02};

Problem robot() {
  Problem problem;
  problem.constants.turn_first = false;
  problem.walk = sigmaban::sigmaban_walk();
  problem.noise = {.per_speed = 2 * sigmaban::sigmaban_noise().as_motion_noise().constant};
  return problem;
}

void play(const char* name, const Problem& believed, double budget, std::uint64_t seed) {
  surefoot::RfpiOptions options;
  options.budget.counted_seconds = budget;
  const auto trained =
      surefoot::rfpi(believed, options, surefoot::Threads(), seed, sigmaban::seed_states(believed, seed));
  const surefoot::Estimate cost = surefoot::evaluate(
      robot(), trained.policy, {.runs = 10'000, .horizon = Problem::horizon}, surefoot::Threads(), 2016);
  std::printf("%-24s cost %6.2f as it believes, %6.2f +- %.2f (95 %%) on the robot\n", name, trained.cost.mean,
              -cost.mean, cost.half_width());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const double budget = argc > 2 ? std::strtod(argv[2], nullptr) : 60;
  const auto walks = toys::walks(robot().walk, robot().noise, 60, seed, 25, accuracy);
  const std::span<const surefoot::WalkSequence> all(walks);
  surefoot::CalibrationOptions options;
  options.model.accuracy = accuracy;
  Problem known = robot();
  known.walk = surefoot::calibrate<surefoot::FullLinearCorrection>(all, options).model;
  surefoot::NoiseChoiceOptions choice;
  choice.fit.accuracy = accuracy;
  known.noise = surefoot::choose_noise(known.walk, all, choice, surefoot::Threads()).noise();
  Problem constant = known;
  constant.noise = sigmaban::sigmaban_noise().as_motion_noise();
  std::printf("noise found, at full speed: %.4f m, %.4f m, %.3f rad; standing: %.4f m, %.4f m, %.3f rad\n",
              known.noise.constant[0] + known.noise.per_speed[0], known.noise.constant[1] + known.noise.per_speed[1],
              known.noise.constant[2] + known.noise.per_speed[2], known.noise.constant[0], known.noise.constant[1],
              known.noise.constant[2]);
  play("with calibrated noise", known, budget, seed);
  play("with constant noise", constant, budget, seed);
}

// Calibration on walks whose truth is known: how good predictions, standard errors and the choice of a noise are.
// Every section prints its figures and the share of repetitions they hold in; the seed is an argument.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/compare.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "tests/support/walks.hpp"

namespace {

using surefoot::FullLinearCorrection;
using surefoot::MotionNoise;
using surefoot::NoiseGrowth;
using surefoot::NoiseShape;
using surefoot::Vec;
using surefoot::WalkSequence;

constexpr double bin = std::numbers::pi / 6;  // headings are read off a clock [rad]

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

std::vector<WalkSequence> taped(std::vector<WalkSequence> sequences) {
  for (WalkSequence& sequence : sequences) {
    sequence = final_pose_only(sequence);
    double& heading = sequence.poses(2, sequence.cycles() - 1);
    heading = bin * std::round(heading / bin);
  }
  return sequences;
}

/// Held-out error of final positions after calibration from 25 final poses, against that of the true walk.
void predictions(int repetitions, std::uint64_t seed) {
  const auto judges = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 1000, seed));
  const std::span<const WalkSequence> all(judges);
  const double truth = final_pose_error(toys::paper_walk(), all).position;
  std::printf("predictions: held-out error of final positions [m], %d calibrations from 25 final poses each\n",
              repetitions);
  std::printf("  commands as they are %.3f, true walk %.3f\n", final_pose_error(FullLinearCorrection(), all).position,
              truth);
  surefoot::CalibrationOptions options;
  options.model.accuracy = {.position = 0.005, .heading = 0.02, .heading_tolerance = bin / 2};
  const auto errors = surefoot::map(surefoot::Threads(), static_cast<std::size_t>(repetitions), [&](std::size_t i) {
    const auto walks = taped(toys::walks(toys::paper_walk(), toys::paper_noise(), 25, seed + 1 + i));
    const auto likelihood = surefoot::calibrate<FullLinearCorrection>(walks, options);
    const auto published = surefoot::published_fit<FullLinearCorrection>(walks, {}, surefoot::Serial{}, seed);
    return std::array{final_pose_error(likelihood.model, all).position,
                      final_pose_error(published.model, all).position};
  });
  for (std::size_t method = 0; method < 2; ++method) {
    std::vector<double> ratio;
    for (const auto& error : errors) ratio.push_back(error[method] / truth);
    const double median = quantile(ratio, 0.5);
    std::printf("  %-10s median %.3f = %.3f x true, from %.3f to %.3f x true in 80 %%\n",
                method == 0 ? "likelihood" : "published", median * truth, median, quantile(ratio, 0.1),
                quantile(ratio, 0.9));
  }
}

/// How often the truth lies where the standard errors say, with poses after every cycle.
void intervals(int repetitions, std::uint64_t seed) {
  surefoot::CalibrationOptions options;
  options.model.accuracy = {.position = 0.0005, .heading = 0.001};
  const auto off = surefoot::map(surefoot::Threads(), static_cast<std::size_t>(repetitions), [&](std::size_t i) {
    const auto walks = toys::walks(toys::paper_walk(), toys::paper_noise(), 25, seed + i);
    const auto found = surefoot::calibrate<FullLinearCorrection>(walks, options);
    return Vec<12>((found.model.parameters() - toys::paper_walk().parameters()).cwiseQuotient(found.standard_errors()));
  });
  double three = 0, covered = 0;
  for (const Vec<12>& z : off) {
    three += static_cast<double>((z.array().abs() < 3).count());
    covered += static_cast<double>((z.array().abs() < 1.96).count());
  }
  std::printf(
      "intervals: %d calibrations from 25 sequences with all poses: %.2f %% of coefficients within 3 standard "
      "errors, 95 %% intervals cover %.1f %%\n",
      repetitions, 100 * three / (12.0 * repetitions), 100 * covered / (12.0 * repetitions));
}

MotionNoise noise_of(NoiseShape shape, NoiseGrowth growth) {
  MotionNoise noise{.shape = shape};
  if (growth == NoiseGrowth::constant) noise.constant = {0.0115, 0.0115, 0.05};
  if (growth == NoiseGrowth::with_speed) noise.per_speed = {0.015, 0.015, 0.06};
  if (growth == NoiseGrowth::with_speed_and_acceleration) {
    noise.constant = {0.004, 0.004, 0.015};
    noise.per_speed = {0.01, 0.01, 0.04};
    noise.per_acceleration = {0.006, 0.006, 0.03};
  }
  return noise;
}

/// Relative errors of all terms that are not 0.
void add_errors(const Vec<3>& found, const Vec<3>& truth, std::vector<double>& errors) {
  for (int i = 0; i < 3; ++i) {
    if (truth[i] > 0) errors.push_back(std::abs(found[i] / truth[i] - 1));
  }
}

/// How often the noise that was put in is chosen, and how well its terms are found again.
void noises(int repetitions, std::uint64_t seed) {
  struct Result {
    int right = 0;
    std::vector<double> errors;
  };
  surefoot::CalibrationOptions options;
  options.model.accuracy = {.position = 0.001, .heading = 0.002};
  const auto results = surefoot::map(surefoot::Threads(), static_cast<std::size_t>(repetitions), [&](std::size_t i) {
    const auto shape = static_cast<NoiseShape>(i % 2);
    const auto growth = static_cast<NoiseGrowth>(i / 2 % 3);
    const MotionNoise truth = noise_of(shape, growth);
    const auto walks = toys::walks(toys::paper_walk(), truth, 60, seed + i);
    const auto calibration = surefoot::calibrate<FullLinearCorrection>(walks, options);
    const auto choice = surefoot::choose_noise(calibration.model, std::span<const WalkSequence>(walks),
                                               {.fit = {.accuracy = options.model.accuracy}}, surefoot::Serial{});
    const auto& chosen = choice.candidates[choice.chosen];
    Result result{.right = chosen.shape == shape && chosen.growth == growth, .errors = {}};
    if (result.right == 0) return result;
    add_errors(chosen.noise.constant, truth.constant, result.errors);
    add_errors(chosen.noise.per_speed, truth.per_speed, result.errors);
    add_errors(chosen.noise.per_acceleration, truth.per_acceleration, result.errors);
    return result;
  });
  int right = 0;
  std::vector<double> errors;
  for (const Result& result : results) {
    right += result.right;
    errors.insert(errors.end(), result.errors.begin(), result.errors.end());
  }
  std::printf(
      "noises: %d data sets of 60 sequences with all poses: %.1f %% right shape and growth, terms off by %.1f %% "
      "(median), below %.1f %% in 80 %%\n",
      repetitions, 100.0 * right / repetitions, 100 * quantile(errors, 0.5), 100 * quantile(errors, 0.8));
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const int percent = argc > 2 ? std::atoi(argv[2]) : 100;  // of the full number of repetitions
  const auto times = [&](int full) { return std::max(4, full * percent / 100); };
  predictions(times(100), 1'000'000 * seed);
  intervals(times(300), 2'000'000 * seed);
  noises(times(200), 3'000'000 * seed);
}

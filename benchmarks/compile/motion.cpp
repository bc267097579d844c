// A user of motion models: calibrates one from walks, here simulated ones.
#include "surefoot/motion.hpp"

#include <cstdio>
#include <vector>

int main() {
  const auto walk = surefoot::ProportionalCorrection::from_parameters(surefoot::Vec<3>(1.1, 0.9, 1.2));
  const surefoot::UniformNoise noise{{0.01, 0.01, 0.05}};
  const surefoot::PoseAccuracy accuracy{.position = 0.005, .heading = 0.02};
  std::vector<surefoot::WalkSequence> walks;
  for (std::uint64_t i = 0; i < 25; ++i) {
    const Eigen::Matrix3Xd steps = 0.05 * Eigen::Matrix3Xd::Random(3, 25);
    surefoot::Rng rng(1, i);
    walks.push_back(surefoot::simulate_walk(walk, noise, accuracy, surefoot::planned_sequence(steps, true), rng));
  }
  surefoot::CalibrationOptions options;
  options.model.accuracy = accuracy;
  const auto found = surefoot::calibrate<surefoot::FullLinearCorrection>(walks, options);
  for (Eigen::Index i = 0; i < found.model.parameters().size(); ++i) {
    std::printf("%.3f +- %.3f\n", found.model.parameters()[i], found.standard_errors()[i]);
  }
}

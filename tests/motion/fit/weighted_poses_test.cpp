#include "surefoot/motion/fit/weighted_poses.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/optimize/numeric_jacobian.hpp"
#include "tests/support/walks.hpp"

TEST_CASE("the Jacobian of the residuals is that of numeric differences") {
  auto walks = toys::walks(toys::paper_walk(), toys::paper_noise(), 3, 2);
  walks[1] = final_pose_only(walks[1]);
  walks[2].poses(2, 24) = std::nan("");
  const auto noise = toys::paper_noise().as_motion_noise();
  const surefoot::detail::WeightedPoses poses(toys::paper_walk(), noise, surefoot::PoseAccuracy(), 0.25, walks);
  const Eigen::VectorXd p = surefoot::Vec<12>(toys::paper_walk().parameters().array() + 0.01);
  const Eigen::MatrixXd exact = poses.jacobian(p);
  const Eigen::MatrixXd numeric =
      surefoot::numeric_jacobian([&](const Eigen::VectorXd& q) { return poses.residuals(q); }, p);
  CHECK((exact - numeric).norm() < 1e-5 * numeric.norm());
}

TEST_CASE("residuals are whitened innovations, and then how far parameters are from their defaults") {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 2, 3));
  const surefoot::detail::WeightedPoses poses(toys::paper_walk(), toys::paper_noise().as_motion_noise(),
                                              surefoot::PoseAccuracy(), 0.5, walks);
  const Eigen::VectorXd residuals = poses.residuals(toys::paper_walk().parameters());
  REQUIRE(residuals.size() == 2 * 3 + 12);
  const auto box = surefoot::parameter_box<surefoot::FullLinearCorrection>();
  CHECK(residuals[6 + 1] == doctest::Approx((1.30 - 1) / (0.5 * box.width()[1])));
}

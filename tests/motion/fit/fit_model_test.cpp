#include "surefoot/motion/fit/fit_model.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "surefoot/motion/previous_command_correction.hpp"
#include "tests/support/quadratic_correction.hpp"
#include "tests/support/walks.hpp"

using surefoot::FullLinearCorrection;
using surefoot::MotionNoise;
using surefoot::Vec;

namespace {

const MotionNoise little{.constant = {0.001, 0.001, 0.005}};

template <class Model>
Model some_walk() {
  Vec<Model::parameter_count> p = Model().parameters();
  for (int i = 0; i < Model::parameter_count; ++i) p[i] += 0.01 * (1 + i % 3);
  return Model::from_parameters(p);
}

}  // namespace

TEST_CASE_TEMPLATE("a walk is found again from final poses", Model, surefoot::ProportionalCorrection,
                   surefoot::SimpleLinearCorrection, FullLinearCorrection, surefoot::PreviousCommandCorrection,
                   toys::QuadraticCorrection) {
  const Model truth = some_walk<Model>();
  const auto walks = toys::final_poses(toys::walks(truth, little, 60, 1));
  const surefoot::ModelFitOptions options{.accuracy = {.position = 1e-4, .heading = 1e-4}};
  const auto fit = surefoot::fit_model<Model>(walks, little, options);
  CHECK(fit.converged);
  const Vec<Model::parameter_count> off =
      (fit.model.parameters() - truth.parameters()).cwiseQuotient(fit.standard_errors());
  CHECK(off.template lpNorm<Eigen::Infinity>() < 4);
  CHECK(surefoot::final_pose_error(fit.model, std::span<const surefoot::WalkSequence>(walks)).position < 0.02);
}

TEST_CASE("what commands never excite keeps its default, and its standard error says so") {
  auto walks = toys::walks(toys::paper_walk(), toys::paper_noise(), 20, 3);
  for (auto& walk : walks) walk.commands.row(1).setZero();  // never a lateral command
  const auto fit = surefoot::fit_model<FullLinearCorrection>(walks, toys::paper_noise().as_motion_noise());
  CHECK(fit.model.parameters()[6] == doctest::Approx(1));
  CHECK(fit.standard_errors()[6] > 0.5);   // of dy per dy, whose prior is 0.75
  CHECK(fit.standard_errors()[1] < 0.05);  // of dx per dx
}

TEST_CASE("a wrong reading decides a squared fit but not a robust one") {
  auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 40, 4));
  const auto noise = toys::paper_noise().as_motion_noise();
  const auto clean = surefoot::fit_model<FullLinearCorrection>(walks, noise);
  walks[0].poses.col(24) += Vec<3>{3, -3, 0};
  const auto moved_by = [&](surefoot::Loss loss) {
    const auto fit = surefoot::fit_model<FullLinearCorrection>(walks, noise, {.loss = loss});
    return (fit.model.parameters() - clean.model.parameters()).cwiseQuotient(clean.standard_errors()).norm();
  };
  CHECK(moved_by(surefoot::Loss::huber) < 0.5 * moved_by(surefoot::Loss::squared));
}

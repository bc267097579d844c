#include "surefoot/motion/any_motion_model.hpp"

#include <doctest/doctest.h>

#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/previous_command_correction.hpp"
#include "tests/support/quadratic_correction.hpp"
#include "tests/support/walks.hpp"

using surefoot::AnyMotionModel;
using surefoot::Vec;

TEST_CASE_TEMPLATE("any model moves as its own type does", Model, surefoot::ProportionalCorrection,
                   surefoot::SimpleLinearCorrection, surefoot::FullLinearCorrection,
                   surefoot::PreviousCommandCorrection, toys::QuadraticCorrection) {
  Vec<Model::parameter_count> parameters = Model().parameters();
  for (int i = 0; i < Model::parameter_count; ++i) parameters[i] += 0.01 * (1 + i % 3);
  const Model model = Model::from_parameters(parameters);
  const AnyMotionModel any = model;
  CHECK(any.parameters() == parameters);
  CHECK(any.default_parameters() == Model().parameters());
  CHECK(any.name() == surefoot::model_name<Model>());
  CHECK(any.parameter_box().high() == surefoot::parameter_box<Model>().high());
  CHECK(any.as<Model>().parameters() == parameters);
  const Eigen::Matrix3Xd commands = surefoot::plan_commands({}, 1, 5, 1)[0];
  Vec<3> previous{0.01, 0.02, 0.03};
  const Eigen::Matrix3Xd displacements = any.displacements(commands, previous);
  for (Eigen::Index i = 0; i < 5; ++i) {
    CHECK(displacements.col(i) == surefoot::cycle_displacement(model, commands.col(i), previous).vec());
    previous = commands.col(i);
  }
}

TEST_CASE("a model is not taken for one of another type or size") {
  const AnyMotionModel any = surefoot::ProportionalCorrection();
  CHECK_THROWS_WITH_AS(any.as<surefoot::FullLinearCorrection>(), "the model is proportional, not full linear",
                       surefoot::MotionError);
  CHECK_THROWS_WITH_AS(any.with_parameters(Eigen::VectorXd::Ones(4)), "the model proportional has 3 parameters, got 4",
                       surefoot::MotionError);
}

#include "surefoot/motion/motion_model.hpp"

#include <doctest/doctest.h>

#include <array>

#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/previous_command_correction.hpp"

namespace {

/// The smallest conforming struct of the header.
struct Scale {
  static constexpr int parameter_count = 1;
  static std::array<surefoot::ModelParameter, 1> parameter_info() { return {{{"scale", "1", 0.5, 2.0}}}; }
  static Scale from_parameters(const surefoot::Vec<1>& p) { return {p[0]}; }
  surefoot::Vec<1> parameters() const { return surefoot::Vec<1>(scale); }
  surefoot::Pose2 displacement(const surefoot::Vec<3>& commands) const {
    return surefoot::Pose2::from_vec(scale * commands);
  }
  double scale = 1;
};

}  // namespace

TEST_CASE("a struct of four members is a motion model, named by its parameters") {
  static_assert(surefoot::MotionModel<Scale>);
  CHECK(surefoot::model_name<Scale>() == "1 parameters");
  CHECK(surefoot::parameter_box<Scale>().low()[0] == 0.5);
  CHECK(surefoot::cycle_displacement(Scale{2}, {1, 2, 3}, {4, 5, 6}).vec() == surefoot::Vec<3>{2, 4, 6});
}

TEST_CASE("a model that does not ask for the previous command is not told") {
  const surefoot::FullLinearCorrection full;
  CHECK(cycle_displacement(full, {1, 2, 3}, {4, 5, 6}).vec() == surefoot::Vec<3>{1, 2, 3});
  CHECK(surefoot::model_name<surefoot::FullLinearCorrection>() == "full linear");
}

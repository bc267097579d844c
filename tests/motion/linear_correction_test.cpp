#include "surefoot/motion/linear_correction.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string_view>

#include "surefoot/core/rng.hpp"
#include "surefoot/motion/previous_command_correction.hpp"
#include "tests/support/quadratic_correction.hpp"

using surefoot::FullLinearCorrection;
using surefoot::ProportionalCorrection;
using surefoot::SimpleLinearCorrection;
using surefoot::Vec;

// What every motion model owes its users; a new one joins the list.
TEST_CASE_TEMPLATE("a motion model", Model, ProportionalCorrection, SimpleLinearCorrection, FullLinearCorrection,
                   surefoot::PreviousCommandCorrection, toys::QuadraticCorrection) {
  static_assert(surefoot::MotionModel<Model>);
  const surefoot::Box<Model::parameter_count> box = surefoot::parameter_box<Model>();
  surefoot::Rng rng(1);

  SUBCASE("gives back the parameters it was made from") {
    const auto parameters = box.sample(rng);
    CHECK(Model::from_parameters(parameters).parameters() == parameters);
  }
  SUBCASE("obeys its commands by default, which lies in its ranges") {
    CHECK(surefoot::cycle_displacement(Model(), {0.1, -0.2, 0.3}, {0.5, 0.5, 0.5}).vec() == Vec<3>{0.1, -0.2, 0.3});
    CHECK(box.contains(Model().parameters()));
  }
  SUBCASE("moves differently when any one of its parameters changes") {
    for (int i = 0; i < Model::parameter_count; ++i) {
      auto parameters = Model().parameters();
      parameters[i] += 0.1;
      CHECK(surefoot::cycle_displacement(Model::from_parameters(parameters), {0.3, 0.5, 0.7}, {0.2, 0.4, 0.6}).vec() !=
            Vec<3>{0.3, 0.5, 0.7});
    }
  }
  SUBCASE("names every parameter once, with a unit and a range") {
    std::set<std::string_view> names;
    for (const surefoot::ModelParameter& parameter : Model::parameter_info()) {
      names.insert(parameter.name);
      CHECK_FALSE(parameter.unit.empty());
      CHECK(parameter.low < parameter.high);
    }
    CHECK(names.size() == Model::parameter_count);
  }
}

TEST_CASE("the full correction is equation 1, coefficients row by row") {
  Vec<12> coefficients;
  coefficients << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12;
  const auto moved = FullLinearCorrection::from_parameters(coefficients).displacement({10, 100, 1000}).vec();
  CHECK(moved == Vec<3>{4321, 8765, 13209});
}

TEST_CASE("the smaller corrections leave out the cross terms, the smallest the offsets too") {
  Vec<6> simple;
  simple << 1, 2, 3, 4, 5, 6;
  CHECK(SimpleLinearCorrection::from_parameters(simple).displacement({10, 100, 1000}).vec() == Vec<3>{21, 403, 6005});
  CHECK(ProportionalCorrection::from_parameters({2, 3, 4}).displacement({10, 100, 1000}).vec() ==
        Vec<3>{20, 300, 4000});
}

TEST_CASE("names and units follow the parameters") {
  CHECK(SimpleLinearCorrection::parameter_info()[2].name == "dy offset");
  CHECK(SimpleLinearCorrection::parameter_info()[5].name == "dt per dt");
  CHECK(ProportionalCorrection::parameter_info()[1].name == "dy per dy");
  CHECK(FullLinearCorrection::parameter_info()[9].name == "dt per dx");
  CHECK(FullLinearCorrection::parameter_info()[9].unit == "rad/m");
}

// Detection limits from proposals.
#include "surefoot/diagnose/verdict/detection_limits.hpp"

#include <doctest/doctest.h>

#include <utility>
#include <vector>

#include "surefoot/diagnose/effects/constant_rate.hpp"
#include "surefoot/diagnose/effects/leak.hpp"
#include "surefoot/diagnose/effects/sensor_bias.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a limit is the strength that could just be seen; effects without one, or without a signature, have none") {
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 50)});
  const auto proposal = [&](const Effect& effect, double visible) {
    Proposal one;
    one.effect = attachments(bound, {effect}, {true, true}).front();
    one.tried = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(effect.parameters.size()), 0.1);
    one.visible = visible;
    return one;
  };
  const auto limits = detection_limits(bound, {proposal(effects::sensor_bias(), 3),
                                               proposal(effects::constant_rate(), 2), proposal(effects::leak(), 0)});
  REQUIRE(limits.size() == 2);
  CHECK(limits[0].name == "constant_rate");  // by name
  CHECK(limits[0].smallest.value == doctest::Approx(0.2));
  CHECK(limits[0].smallest.unit == "m/s");
  CHECK(limits[1].attached_to == "level_m");
}

TEST_CASE("of several forms at one place the plain one has a limit, and none that would be far too large") {
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 50)});
  Effect plain = effects::sensor_bias(), other = plain;
  other.form = "other";
  std::vector<Proposal> proposals;
  for (const Effect* effect : {&other, &plain, &other}) {
    Proposal one;
    one.effect = attachments(bound, {*effect}, {true, true}).front();
    one.tried = Eigen::VectorXd::Constant(1, 0.1);
    proposals.push_back(std::move(one));
  }
  const auto limits_of = [&](double first, double second, double third) {
    proposals[0].visible = first;
    proposals[1].visible = second;
    proposals[2].visible = third;
    return detection_limits(bound, proposals);
  };
  REQUIRE(limits_of(2, 3, 1).size() == 1);
  CHECK(limits_of(2, 3, 1)[0].smallest.value == doctest::Approx(0.3));
  REQUIRE(limits_of(2, 3000, 1).size() == 1);
  CHECK(limits_of(2, 3000, 1)[0].smallest.value == doctest::Approx(0.1));
  CHECK(limits_of(1, 3000, 1).size() == 1);
  CHECK(limits_of(3000, 0, 3000).empty());
}

}  // namespace
}  // namespace surefoot::diagnosis

// Where effects may attach.
#include "surefoot/diagnose/selection/candidates.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "surefoot/diagnose/effects/constant_force.hpp"
#include "surefoot/diagnose/effects/constant_rate.hpp"
#include "surefoot/diagnose/effects/dead_zone.hpp"
#include "surefoot/diagnose/effects/gravity_offset.hpp"
#include "surefoot/diagnose/effects/input_asymmetry.hpp"
#include "surefoot/diagnose/effects/leak.hpp"
#include "surefoot/diagnose/effects/overflow.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/servo_pendulum.hpp"

namespace surefoot::diagnosis {
namespace {

/// A car in the plane: nothing depends on where it is.
struct Car {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<2>;

  SimulatorInfo info() const {
    return {.name = "car",
            .states = {{"x", "m"}, {"yaw", "rad"}},
            .inputs = {{"speed", "m/s"}},
            .outputs = {{"x_m", "m"}, {"yaw_rad", "rad"}},
            .parameters = {{"turn", "rad/m", 1, 0.2, 5}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {u[0] * std::cos(x[1]), p[0] * u[0]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

std::vector<std::string> places(const BoundSimulator& bound, const Effect& effect) {
  std::vector<std::string> result;
  for (const AttachedEffect& one : attachments(bound, {effect}, std::vector<bool>(bound.info.inputs.size(), true))) {
    result.push_back(one.place);
  }
  return result;
}

// Two stores that empty into each other.
struct TwoTanks {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<2>;

  SimulatorInfo info() const {
    return {.name = "two tanks",
            .states = {{"upper", "m"}, {"lower", "m"}},
            .inputs = {{"pump", "1"}},
            .outputs = {{"upper_m", "m"}, {"lower_m", "m"}},
            .parameters = {{"hole", "1/s", 1, 0.2, 5}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {u[0] - p[0] * x[0], p[0] * (x[0] - x[1])};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

TEST_CASE("what spills over spills into any other store") {
  const Effect spilling = effects::overflow_spill();
  REQUIRE(spilling.has_overflow_target);
  const BoundSimulator bound = bind_simulator(TwoTanks{}, {toys::blank_recording(TwoTanks{}.info(), 100, 0.1)});
  const auto found = attachments(bound, {spilling}, {true});
  REQUIRE(found.size() == 2);
  for (const AttachedEffect& one : found) CHECK(one.other == 1 - one.at);
}

TEST_CASE("a store can leak and overflow, a place and an angle cannot") {
  const BoundSimulator tank =
      bind_simulator(toys::LeakyTank{}, {toys::blank_recording(toys::LeakyTank{}.info(), 100, 0.1)});
  const BoundSimulator car = bind_simulator(Car{}, {toys::blank_recording(Car{}.info(), 100, 0.1)});
  for (const Effect& effect : {effects::leak(), effects::leak_hole(), effects::overflow()}) {
    CAPTURE(effect.name);
    CHECK(places(tank, effect) == std::vector<std::string>{"level"});
    CHECK(places(car, effect).empty());
  }
  CHECK(places(car, effects::constant_rate()) == std::vector<std::string>{"x", "yaw"});
}

TEST_CASE("a turning wheel without an angle has no weight off its axle") {
  struct Wheel : toys::LeakyTank {
    SimulatorInfo info() const {
      SimulatorInfo wheel = toys::LeakyTank::info();
      wheel.states[0].unit = "rad/s";
      return wheel;
    }
  };
  const BoundSimulator wheel = bind_simulator(Wheel{}, {toys::blank_recording(Wheel{}.info(), 100, 0.1)});
  CHECK(places(wheel, effects::constant_force()) == std::vector<std::string>{"level"});
  CHECK(places(wheel, effects::gravity_offset()).empty());
}

TEST_CASE("it is known which inputs begin at zero in all recordings") {
  Recording still = toys::blank_recording(TwoTanks{}.info(), 100, 0.1), pumped = still;
  still.inputs(0, 1) = 1;
  pumped.inputs(0, 0) = 1;
  const BoundSimulator bound = bind_simulator(TwoTanks{}, {still, pumped});
  CHECK(zero_at_first(bound, {0}) == std::vector<bool>{true});
  CHECK(zero_at_first(bound, {0, 1}) == std::vector<bool>{false});
}

TEST_CASE("an asymmetry is tried only on what is above zero at times and below it at others") {
  Recording one_way = toys::blank_recording(toys::LeakyTank{}.info(), 100, 0.1), back = one_way;
  one_way.inputs.setConstant(2);
  back.inputs.setConstant(-1);
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {one_way, back});
  const Hypothesis base = nominal_hypothesis(bound);
  const auto signs_in = [&](const std::vector<std::size_t>& recordings) {
    return input_values(bound, base, recordings, simulate_all(bound, base, recordings, {}, serially())).both_signs;
  };
  CHECK(signs_in({0}) == std::vector<bool>{false, false});  // the valve, and the inflow that it makes
  CHECK(signs_in({1}) == std::vector<bool>{false, false});
  CHECK(signs_in({0, 1}) == std::vector<bool>{true, true});
  CHECK(effects::input_asymmetry().needs_both_signs);
}

TEST_CASE("a zone in which nothing happens is looked for only where some values are small") {
  Recording one = toys::blank_recording(toys::LeakyTank{}.info(), 100, 0.1);
  const auto small_with = [&](double value) -> bool {
    one.inputs.setConstant(2);
    one.inputs(0, 50) = value;
    const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {one});
    const Hypothesis base = nominal_hypothesis(bound);
    return input_values(bound, base, {0}, simulate_all(bound, base, {0}, {}, serially())).small_values[0];
  };
  CHECK(small_with(-0.5));
  CHECK_FALSE(small_with(1.5));
  CHECK_FALSE(small_with(0));
  CHECK(effects::dead_zone_step().needs_small_values);
}

// A cart that moves by its command and by that of the step before.
struct Cart {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "cart",
            .kind = SimulatorKind::map,
            .states = {{"x", "m"}, {"last", "m"}},
            .inputs = {{"step", "m"}},
            .outputs = {{"x_m", "m"}},
            .parameters = {}};
  }
  State next(const State& x, const Input& u, const Eigen::VectorXd& /*p*/) const {
    return {x[0] + 0.8 * u[0] + 0.2 * x[1], u[0]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x.head<1>(); }
};

TEST_CASE("nothing acts on the memory of a command") {
  const BoundSimulator cart = bind_simulator(Cart{}, {toys::blank_recording(Cart{}.info(), 100, 1)});
  for (const Effect& effect : {effects::leak(), effects::overflow(), effects::constant_rate()}) {
    CAPTURE(effect.name);
    CHECK(places(cart, effect) == std::vector<std::string>{"x"});
  }
}

TEST_CASE("a position in a unit that is no angle has no weight off its line") {
  struct Circuit : toys::ServoPendulum {
    std::string unit = "rad";
    SimulatorInfo info() const {
      SimulatorInfo circuit = toys::ServoPendulum::info();
      circuit.states[0].unit = unit;
      return circuit;
    }
  };
  const auto places_in = [](const std::string& unit) {
    Circuit circuit;
    circuit.unit = unit;
    return places(bind_simulator(circuit, {toys::blank_recording(circuit.info(), 100, 0.1)}),
                  effects::gravity_offset());
  };
  for (const char* angle : {"rad", "deg", "1", ""}) CHECK(places_in(angle) == std::vector<std::string>{"omega"});
  for (const char* other : {"V", "m", "mm"}) CHECK(places_in(other).empty());
}

}  // namespace
}  // namespace surefoot::diagnosis

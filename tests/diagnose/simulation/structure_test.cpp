// What a simulator tells about itself when asked.
#include "surefoot/diagnose/simulation/structure.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "surefoot/diagnose/simulation/bound_simulator.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/servo_pendulum.hpp"
#include "tests/support/walking_robot.hpp"

namespace surefoot::diagnosis {
namespace {

template <class S>
SimulatorStructure facts_of(const S& simulator, const Recording& recording) {
  const SimulatorInfo info = simulator.info();
  return find_structure(simulator, info, recording, recording, nominal_parameters(info));
}

TEST_CASE("the state whose rate is another state is its position, and forces act on that other") {
  const auto structure = facts_of(toys::SlidingBlock{}, toys::blank_recording(toys::SlidingBlock{}.info(), 5, 0.1));
  CHECK(structure.position_of == std::vector<int>{-1, 0});
  CHECK(structure.velocity == std::vector<bool>{false, true});
  CHECK(structure.output_of == std::vector<int>{0, 1});
  CHECK(structure.all_states_measured);
}

// A block whose place is read in cm behind the zero of the sensor, and whose speed by a gain to be calibrated.
struct ReadOtherwise : toys::SlidingBlock {
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& p) const {
    return {100 * x[0] - 5, p[0] * x[1]};
  }
};

TEST_CASE("an output may read a state in another unit and from another zero, but by no gain that is not known") {
  const auto structure = facts_of(ReadOtherwise{}, toys::blank_recording(ReadOtherwise{}.info(), 5, 0.1));
  CHECK(structure.output_of == std::vector<int>{0, -1});
  CHECK(reading_of(structure, 0).slope == doctest::Approx(100));
  CHECK(reading_of(structure, 0).offset == doctest::Approx(-5));
  CHECK(reading_of(structure, 0).state_at(95) == doctest::Approx(1));
  CHECK(reading_of(structure, 0).reading_at(1) == doctest::Approx(95));
  CHECK_FALSE(structure.all_states_measured);
}

TEST_CASE("a level is no velocity, and neither are the states of a map") {
  const auto tank = facts_of(toys::LeakyTank{}, toys::tank_recording(0, 20));
  CHECK(tank.velocity == std::vector<bool>{false});
  CHECK(tank.position_of == std::vector<int>{-1});
  const auto robot =
      facts_of(toys::WalkingRobot{}, toys::walk_recordings([](Pose2 moved, Pose2) { return moved; }, false, 1, 1)[0]);
  CHECK(robot.velocity == std::vector<bool>(3, false));
  CHECK(robot.output_of == std::vector<int>{0, 1, 2});
}

// A cart whose speed is the mean of this command and the two before, which it keeps.
struct Sluggish {
  using State = Vec<3>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  SimulatorInfo info() const {
    return {.name = "sluggish",
            .kind = SimulatorKind::map,
            .states = {{"x", "m"}, {"last", "m"}, {"one_before", "m"}},
            .inputs = {{"step", "m"}},
            .outputs = {{"x_m", "m"}},
            .parameters = {}};
  }
  State next(const State& x, const Input& u, const Eigen::VectorXd& /*p*/) const {
    return {x[0] + (u[0] + x[1] + x[2]) / 3, u[0], x[1]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x.head<1>(); }
};

TEST_CASE("states of a map that only keep commands are known with them") {
  const auto structure = facts_of(Sluggish{}, toys::blank_recording(Sluggish{}.info(), 5, 1));
  CHECK(structure.remembers == std::vector<bool>{false, true, true});
  CHECK(structure.all_states_measured);
  const auto tank = facts_of(toys::LeakyTank{}, toys::tank_recording(0, 20));
  CHECK(tank.remembers == std::vector<bool>{false});
}

TEST_CASE("signals count as driven even where orders far away saturate them") {
  for (const double goal : {0.0, 0.6, -0.6, -1.5, 3.0}) {
    Recording recording = toys::blank_recording(toys::ServoPendulum{}.info(), 50, 0.01);
    recording.inputs.setConstant(goal);
    const auto structure = facts_of(toys::ServoPendulum{}, recording);
    CHECK(structure.driven_signal == std::vector<bool>{true, true});
    CHECK_FALSE(structure.all_states_measured);  // the speed is not
  }
}

/// Shows the force of its second input, as a load cell does.
struct WeighedBlock : toys::SlidingBlock {
  using Input = Vec<2>;
  using Output = Vec<2>;
  SimulatorInfo info() const {
    SimulatorInfo info = SlidingBlock::info();
    info.inputs.push_back({"weight", "N"});
    return info;
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return SlidingBlock::derivative(x, u.head<1>(), p);
  }
  Output observe(const State& x, const Input& u, const Eigen::VectorXd&) const { return {x[0], x[1] + u[1]}; }
};

TEST_CASE("inputs that an output shows at once are known") {
  const auto weighed = facts_of(WeighedBlock{}, toys::blank_recording(WeighedBlock{}.info(), 5, 1));
  CHECK(weighed.shown_at_once == std::vector<bool>{false, true});
}

// A motor with a coil, behind an amplifier with a lag, and a battery that nothing of it drains.
struct MotorWithCoil {
  using State = Vec<5>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  SimulatorInfo info() const {
    return {.name = "motor_with_coil",
            .states = {{"angle", "rad"}, {"speed", "rad/s"}, {"current", "A"}, {"amplified", "V"}, {"charge", "C"}},
            .inputs = {{"voltage", "V"}},
            .outputs = {{"angle_rad", "rad"}},
            .parameters = {}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& /*p*/) const {
    return {x[1], 3 * x[2] - 0.1 * x[1], 5 * (x[3] - 2 * x[2] - 0.3 * x[1]), 20 * (u[0] - x[3]), -0.01 * x[4]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x.head<1>(); }
};

TEST_CASE("states between the inputs and what moves are those of an actuator") {
  const auto motor = facts_of(MotorWithCoil{}, toys::blank_recording(MotorWithCoil{}.info(), 5, 0.1));
  CHECK(motor.actuator == std::vector<bool>{false, false, true, true, false});
  const auto block = facts_of(toys::SlidingBlock{}, toys::blank_recording(toys::SlidingBlock{}.info(), 5, 0.1));
  CHECK(block.actuator == std::vector<bool>{false, false});
}

// Two bodies, driven by a current; a spring between them whose stretch is a state; a mass as a signal.
struct StretchedPair {
  using State = Vec<4>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  SimulatorInfo info() const {
    return {.name = "stretched_pair",
            .states = {{"current", "A"}, {"first", "m/s"}, {"second", "m/s"}, {"stretch", "m"}},
            .inputs = {{"voltage", "V"}},
            .outputs = {{"second_m_s", "m/s"}},
            .parameters = {},
            .signals = {"pull", "spring", "mass", "heat"}};
  }
  template <class Tap>
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& /*p*/, Tap&& tap) const {
    tap(3, 2 * x[0] * x[0]);  // driven by the current, and moves nothing
    const double pull = tap(0, 3 * x[0]), spring = tap(1, 40 * x[3]), mass = tap(2, 2 + 0.1 * x[3]);
    return {5 * (u[0] - x[0]), (pull - spring) / mass, spring / mass, x[1] - x[2]};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return derivative(x, u, p, NoTap{});
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[2]); }
};

TEST_CASE("a force that comes of the state of an actuator is driven; what does not move anything is not") {
  const auto structure = facts_of(StretchedPair{}, toys::blank_recording(StretchedPair{}.info(), 5, 0.1));
  CHECK(structure.driven_signal == std::vector<bool>{true, false, false, false});
}

TEST_CASE("a coupling is a force on several speeds, whatever their positions are called; a mass is none") {
  const auto structure = facts_of(StretchedPair{}, toys::blank_recording(StretchedPair{}.info(), 5, 0.1));
  CHECK(structure.coupling == std::vector<bool>{false, true, false, false});
}

// A speed in degrees; a force that no input drives; an output that shows the speed times ten.
struct Odd {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<2>;
  SimulatorInfo info() const {
    return {.name = "odd",
            .states = {{"angle", "deg"}, {"speed", "rad/s"}},
            .inputs = {{"u", "1"}},
            .outputs = {{"ten_speeds", "rad/s"}, {"angle", "deg"}},
            .parameters = {},
            .signals = {"drag", "thrust"}};
  }
  template <class Tap>
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& /*p*/, Tap&& tap) const {
    return {57.3 * x[1], tap(1, 3 * u[0]) - tap(0, 0.1 * x[1])};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return derivative(x, u, p, NoTap{});
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return {10 * x[1], x[0]}; }
};

TEST_CASE(
    "nothing is taken for a speed or a driven signal that is only nearly one, but a reading may be in another unit") {
  const auto structure = facts_of(Odd{}, toys::blank_recording(Odd{}.info(), 5, 0.1));
  CHECK(structure.position_of == std::vector<int>{-1, -1});
  CHECK(structure.velocity == std::vector<bool>{false, true});  // by its unit
  CHECK(structure.output_of == std::vector<int>{1, 0});
  CHECK(reading_of(structure, 1).slope == doctest::Approx(10));
  CHECK(structure.driven_signal == std::vector<bool>{false, true});
}

// A simulator that is another one for each recording.
struct ByRecording {
  using State = Vec<1>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  double scale = 0;
  SimulatorInfo info() const {
    return {.name = "by recording",
            .states = {{"x", "1"}},
            .inputs = {{"u", "1"}},
            .outputs = {{"y", "1"}},
            .parameters = {}};
  }
  ByRecording for_recording(const Recording& recording) const { return {recording.constants.at("scale")}; }
  State derivative(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return -x; }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return scale * x; }
};

TEST_CASE("a simulator is asked as it is for the recording") {
  Recording recording = toys::blank_recording(ByRecording{}.info(), 5, 0.1);
  recording.constants["scale"] = 1;
  CHECK(reading_of(facts_of(ByRecording{}, recording), 0).slope == 1);
  Recording stronger = recording;
  stronger.constants["scale"] = 2;
  CHECK(reading_of(facts_of(ByRecording{}, stronger), 0).slope == doctest::Approx(2));
  const std::vector<Recording> both{recording, recording, stronger};  // no one way to read it
  CHECK(bind_simulator(ByRecording{}, {recording, recording}).structure.all_states_measured);
  CHECK_FALSE(bind_simulator(ByRecording{}, both).structure.all_states_measured);
}

}  // namespace
}  // namespace surefoot::diagnosis

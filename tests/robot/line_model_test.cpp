// Servos of any model are driven by their own registers and units, and those that cannot be driven together are told.
#include "examples/sigmaban/robot/setup/line_model.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "examples/sigmaban/robot/servos/servo_group.hpp"
#include "examples/sigmaban/robot/virtual_bus/memory_transport.hpp"

using namespace dynamixel;

namespace {

template <class Protocol>
struct ModelLine {
  using Line = Bus<Protocol, MemoryTransport<Protocol>>;

  explicit ModelLine(const std::vector<const char*>& names) : answerer(servos(names)), bus(Port(answerer), {}) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      joints.push_back({.name = "joint " + std::to_string(i + 1), .id = static_cast<std::uint8_t>(i + 1)});
    }
  }
  using Port = MemoryTransport<Protocol>;

  static std::vector<VirtualServo> servos(const std::vector<const char*>& names) {
    std::vector<VirtualServo> made;
    for (const char* name : names)
      made.emplace_back(*find_model(name), static_cast<std::uint8_t>(made.size() + 1), 0.2);
    return made;
  }

  Answerer<Protocol> answerer;
  Line bus;
  std::vector<Joint> joints;
};

/// Torque on, to goals and back to limp. Returns how far the servos are from their goals at most [rad].
template <class Protocol>
double drive(const char* name) {
  ModelLine<Protocol> line({name, name});
  const LineModel model = line_model(line.bus, line.joints, mx_64_protocol_1);
  REQUIRE(model.model->name == name);
  ServoGroup group(line.bus, *model.model, line.joints, {.soft_start_s = 0.2, .alarms = model.alarms});
  group.start();
  double error = 0;
  for (int i = 0; i < 100; ++i) {
    group.set_goals(std::vector<double>{0.5, -0.3});
    group.update();
    line.bus.port().wait(from_seconds(0.005));
    line.answerer.advance(line.bus.port().now());
  }
  for (const int place : {0, 1}) {
    const double goal = place == 0 ? 0.5 : -0.3;
    const auto id = static_cast<std::uint8_t>(place + 1);
    error = std::max(error, std::abs(line.answerer.servo(id).state().position_rad - goal));
    error = std::max(error, std::abs(group.states()[static_cast<std::size_t>(place)].position_rad - goal));
  }
  CHECK_FALSE(group.fault());
  group.stop();
  CHECK_FALSE(line.answerer.servo(1).torque_on());
  return error;
}

}  // namespace

TEST_CASE("servos of every model are driven by their own registers, units and voltages") {
  constexpr double stuck_rad = 0.05;  // by dry friction, with the weak gains of small servos at 5 V
  for (const ServoModel& model : servo_models) {
    const std::string name(model.name);
    CAPTURE(name);
    const double error = model.protocol == 1 ? drive<Protocol1>(name.c_str()) : drive<Protocol2>(name.c_str());
    CHECK(error < stuck_rad);
  }
}

TEST_CASE("models with the same registers go together, others are told by joint") {
  ModelLine<Protocol2> mixed({"MX-64(2.0)", "XL430-W250", "XM430-W350"});
  const LineModel line = line_model(mixed.bus, mixed.joints, mx_64_protocol_2);
  CHECK(line.model->name == "MX-64(2.0)");
  CHECK(line.alarms.high_voltage_v == doctest::Approx(14));  // of the XL430
  ModelLine<Protocol2> apart({"MX-64(2.0)", "XL-320"});
  CHECK_THROWS_WITH_AS(line_model(apart.bus, apart.joints, mx_64_protocol_2),
                       doctest::Contains("joint 2 (servo 2): is of the model XL-320, which cannot be driven together"),
                       BusError);
}

TEST_CASE("a line on which nobody answers has the usual model, and a servo that is not known is told") {
  ModelLine<Protocol2> line({"XM430-W350"});
  line.answerer.set_silent(1, true);
  CHECK(line_model(line.bus, line.joints, mx_64_protocol_2).model == &mx_64_protocol_2);
  line.answerer.set_silent(1, false);
  line.answerer.servo(1).set("model_number", 4242);
  CHECK_THROWS_WITH_AS(line_model(line.bus, line.joints, mx_64_protocol_2), doctest::Contains("model number 4242"),
                       BusError);
}

TEST_CASE("currents are read where all servos of a line have the same") {
  ModelLine<Protocol2> same({"XM430-W350", "XM430-W350"}), mixed({"MX-64(2.0)", "XM430-W350"});
  const LineModel line = line_model(same.bus, same.joints, mx_64_protocol_2);
  CHECK(line.feedback == FeedbackKind::everything);
  CHECK(line_model(mixed.bus, mixed.joints, mx_64_protocol_2).feedback == FeedbackKind::motion_and_health);
  same.answerer.servo(1).load_nm = 1;
  ServoGroup group(same.bus, *line.model, same.joints, {.soft_start_s = 0.2, .feedback = line.feedback});
  group.start();
  for (int i = 0; i < 100; ++i) {
    group.set_goals(std::vector<double>{0.2, 0.2});
    group.update();
    same.bus.port().wait(from_seconds(0.005));
    same.answerer.advance(same.bus.port().now());
  }
  CHECK(std::abs(group.states()[0].current_a - group.states()[1].current_a) > 0.3);  // 1 N m is 0.6 A
}

TEST_CASE("the alarms of a servo are within what its model is made for") {
  const AlarmOptions mx = alarms_of(mx_64_protocol_2), small = alarms_of(*find_model("XL330-M288"));
  CHECK(mx.low_voltage_v == 10.5);
  CHECK(mx.high_voltage_v == 14.8);
  CHECK(mx.hot_celsius == 65);
  CHECK(small.low_voltage_v == doctest::Approx(3.5));
  CHECK(small.high_voltage_v == doctest::Approx(7));
  CHECK(alarms_of(xl_320).hot_celsius == 60);
}

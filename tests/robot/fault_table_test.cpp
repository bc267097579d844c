// Every row of the table of faults in the README, on virtual servos in virtual time: reaction, time to it, torque. The
// measured times are printed where SUREFOOT_PRINT_FAULTS is set.
#include "tests/robot/fault_table.hpp"

#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "tests/robot/walk_scene.hpp"

namespace sigmaban {
namespace {

using dynamixel::Protocol1, dynamixel::Protocol2;
namespace protocol2 = dynamixel::protocol2;

/// What is done to a scene, by the fault's name in the table.
template <class Protocol>
std::map<std::string, std::function<void(WalkScene<Protocol>&)>> common_faults() {
  using Scene = WalkScene<Protocol>;
  const auto share = [](auto member, double value) {
    return [=](Scene& s) { s.once = [&s, member, value] { s.answerer.faults().*member = value; }; };
  };
  using dynamixel::Faults;
  std::map<std::string, std::function<void(Scene&)>> faults;
  faults["nothing"] = [](Scene&) {};
  faults["one answer in fifty lost"] = share(&Faults::lost, 0.02);
  faults["one answer in fifty damaged"] = share(&Faults::corrupted, 0.02);
  faults["one answer in fifty late"] = share(&Faults::late, 0.02);
  faults["one answer in fifty comes twice"] = share(&Faults::duplicated, 0.02);
  faults["one answer in fifty under another id"] = share(&Faults::wrong_id, 0.02);
  faults["one instruction in fifty not heard"] = share(&Faults::unheard, 0.02);
  faults["a servo is silent for half a second"] = [](Scene& s) {
    s.always = [&s, ticks = 0]() mutable { s.answerer.set_silent(4, ++ticks < 50); };
  };
  faults["a servo is silent for good, but hears"] = [](Scene& s) { s.once = [&s] { s.answerer.set_silent(4, true); }; };
  faults["all servos are silent, but hear"] = [](Scene& s) {
    s.once = [&s] {
      for (std::uint8_t id = 1; id <= 12; ++id) s.answerer.set_silent(id, true);
    };
  };
  faults["a servo starts anew (a loose plug)"] = [](Scene& s) { s.once = [&s] { s.answerer.reboot(4, s.now()); }; };
  faults["the same servo starts anew three times"] = [](Scene& s) {
    s.always = [&s, ticks = 0]() mutable {
      if (ticks++ % 100 == 0 && ticks < 300) s.answerer.reboot(4, s.now());
    };
  };
  faults["two servos of a leg start anew"] = [](Scene& s) {
    s.once = [&s] { s.answerer.reboot(4, s.now()), s.answerer.reboot(5, s.now()); };
  };
  faults["the torque of a servo is switched off by somebody"] = [](Scene& s) {
    s.once = [&s] { s.servo(4).set("torque_enable", 0); };
  };
  faults["the gains of a servo are overwritten"] = [](Scene& s) {
    s.once = [&s] { s.servo(4).set(Protocol::version == 1 ? "p_gain" : "position_p_gain", 3); };
  };
  faults["a servo does not keep its torque"] = [](Scene& s) {
    s.always = [&s] { s.servo(4).set("torque_enable", 0); };
  };
  faults["overload of a servo"] = [](Scene& s) { s.once = [&s] { s.servo(4).shut_down(protocol2::overload_error); }; };
  faults["a servo is 90 degrees hot"] = [](Scene& s) { s.once = [&s] { s.servo(4).temperature_celsius = 90; }; };
  faults["the supply sags to 10 V"] = [](Scene& s) { s.once = [&s] { s.answerer.set_voltage(10); }; };
  faults["the supply breaks down for 50 ms"] = [](Scene& s) {
    s.always = [&s, ticks = 0]() mutable { s.answerer.set_voltage(++ticks < 6 ? 5 : 12); };
  };
  faults["the supply rises to 16.5 V"] = [](Scene& s) { s.once = [&s] { s.answerer.set_voltage(16.5); }; };
  faults["the ids of two servos are swapped while it walks"] = [](Scene& s) {
    s.servo(1).load_nm = 0;
    s.once = [&s] { s.answerer.swap_ids(1, 4); };
  };
  faults["the program throws"] = [](Scene& s) { s.once = [] { throw dynamixel::BusError("the walk stumbles"); }; };
  faults["SIGTERM, SIGHUP, Ctrl-C"] = [](Scene& s) { s.signal = [](double) { return StopRequest::in_order; }; };
  faults["two signals"] = [](Scene& s) {
    s.signal = [](double t) { return t < 0.1 ? StopRequest::in_order : StopRequest::at_once; };
  };
  faults["the loop stands still for a second"] = [](Scene& s) {
    s.once = [&s] { s.bus.port().wait(from_seconds(1)); };
  };
  faults["before the start: 10.4 V"] = [](Scene& s) { s.answerer.set_voltage(10.4); };
  faults["before the start: 16.5 V"] = [](Scene& s) { s.answerer.set_voltage(16.5); };
  faults["before the start: a servo is 90 degrees hot"] = [](Scene& s) { s.servo(7).temperature_celsius = 90; };
  faults["before the start: a servo reports an overload"] = [](Scene& s) {
    s.servo(7).shut_down(protocol2::overload_error);
  };
  faults["before the start: a servo is missing"] = [](Scene& s) { s.answerer.set_silent(7, true); };
  faults["before the start: the cable ends behind the sixth servo"] = [](Scene& s) {
    for (std::uint8_t id = 7; id <= 12; ++id) s.servo(id).deaf = true;
  };
  faults["before the start: Status Return Level 0"] = [](Scene& s) { s.servo(7).set("status_return_level", 0); };
  faults["before the start: Status Return Level 1"] = [](Scene& s) { s.servo(7).set("status_return_level", 1); };
  faults["before the start: Return Delay Time 250 (500 us)"] = [](Scene& s) {
    for (std::uint8_t id = 1; id <= 12; ++id) s.servo(id).set("return_delay_time", 250);
  };
  faults["before the start: latency timer of 16 ms"] = [](Scene& s) { s.answerer.set_latency_timer(0.016); };
  faults["before the start: two ids swapped"] = [](Scene& s) {
    s.joints[3].min_rad = -0.1, s.joints[3].max_rad = 2;  // a knee bends one way
    s.joints[4].min_rad = -2, s.joints[4].max_rad = 0.1;
    s.servo(4) = dynamixel::VirtualServo(WalkScene<Protocol>::model, 4, 1.2);
    s.servo(5) = dynamixel::VirtualServo(WalkScene<Protocol>::model, 5, -1.0);
    s.answerer.swap_ids(4, 5);
  };
  return faults;
}

template <class Protocol>
std::map<std::string, std::function<void(WalkScene<Protocol>&)>> faults_of() {
  using Scene = WalkScene<Protocol>;
  auto faults = common_faults<Protocol>();
  if constexpr (Protocol::version == 2) {
    faults["the port hangs up"] = [](Scene& s) { s.once = [&s] { s.bus.port().hang_up(); }; };
    faults["the cable of a servo is cut"] = [](Scene& s) { s.once = [&s] { s.servo(4).deaf = true; }; };
    faults["the cable is cut behind the sixth servo"] = [](Scene& s) {
      s.once = [&s] {
        for (std::uint8_t id = 7; id <= 12; ++id) s.servo(id).deaf = true;
      };
    };
    faults["electrical shock of a servo"] = [](Scene& s) {
      s.once = [&s] { s.servo(4).shut_down(protocol2::electrical_shock_error); };
    };
    faults["the encoder of a servo is broken"] = [](Scene& s) {
      s.once = [&s] { s.servo(4).shut_down(protocol2::motor_encoder_error); };
    };
    faults["an alert without a shutdown"] = [](Scene& s) {
      s.once = [&s] { s.servo(4).set("min_voltage_limit", 125); };
    };
  } else {
    faults["the port hangs up (Protocol 1.0)"] = [](Scene& s) { s.once = [&s] { s.bus.port().hang_up(); }; };
  }
  return faults;
}

std::string in_words(Torque torque) {
  switch (torque) {
    case Torque::all_on:
      return "on";
    case Torque::all_off:
      return "off";
    case Torque::held:
      return "held";
    case Torque::some_on:
      break;
  }
  return "on in some";
}

const std::vector<FaultRow>& table() {
  static const auto rows = read_fault_table(SUREFOOT_SOURCE_DIR "/examples/sigmaban/robot/README.md");
  return rows;
}

template <class Protocol>
std::size_t check_rows() {
  const auto faults = faults_of<Protocol>();
  std::size_t checked = 0;
  for (const FaultRow& row : table()) {
    const auto fault = faults.find(row.fault);
    if (fault == faults.end()) continue;
    ++checked;
    WalkScene<Protocol> scene;
    fault->second(scene);
    const SceneResult result = scene.run();
    CAPTURE(row.fault);
    CAPTURE(result.message);
    CHECK(result.reaction == row.reaction);
    CHECK(in_words(result.torque) == row.torque);
    if (row.within_s > 0) CHECK(result.reacted_s <= row.within_s);
    const bool goes_on = result.reaction == "goes on" || result.reaction == "restores";
    if (goes_on) CHECK(result.at_the_end == Torque::all_off);  // when it is stopped after all
    if (result.reaction == "refuses") CHECK(result.message.find("(servo ") != std::string::npos);
    if (result.reaction == "sits down") CHECK(result.limp_s <= row.within_s + 1.5);
    if (std::getenv("SUREFOOT_PRINT_FAULTS") != nullptr) {
      std::printf("protocol %d | %s | %s | %.2f s | %s | %s\n", Protocol::version, row.fault.c_str(),
                  result.reaction.c_str(), result.reacted_s, in_words(result.torque).c_str(), result.message.c_str());
    }
  }
  return checked;
}

TEST_CASE("the table of faults has a row for each fault that is tried, and no other") {
  std::set<std::string> tried, written;
  for (const auto& [name, fault] : faults_of<Protocol1>()) tried.insert(name);
  for (const auto& [name, fault] : faults_of<Protocol2>()) tried.insert(name);
  for (const FaultRow& row : table()) {
    if (row.fault.find("kill -9") == std::string::npos) written.insert(row.fault);  // of processes: programs_test
  }
  for (const std::string& name : tried) CHECK_MESSAGE(written.contains(name), name);
  for (const std::string& name : written) CHECK_MESSAGE(tried.contains(name), name);
  CHECK(table().size() >= 25);
}

TEST_CASE("faults of servos of Protocol 2.0 are met as the table says") { CHECK(check_rows<Protocol2>() >= 25); }

TEST_CASE("faults of servos of Protocol 1.0 are met as the table says") { CHECK(check_rows<Protocol1>() >= 25); }

}  // namespace
}  // namespace sigmaban

// The body's sensors: from a pipe, from devices on a bus, and what the filter makes of them.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>
#include <vector>

#include "examples/sigmaban/robot/balance/attitude.hpp"
#include "examples/sigmaban/robot/balance/body_source.hpp"
#include "examples/sigmaban/robot/balance/bus_sensors.hpp"
#include "examples/sigmaban/robot/balance/phase_mean.hpp"
#include "examples/sigmaban/robot/bus/bus.hpp"
#include "examples/sigmaban/robot/virtual_bus/memory_transport.hpp"
#include "tests/support/program.hpp"

using namespace sigmaban;
using surefoot::Vec;

namespace {

constexpr double gravity = 9.81;

/// Turning at that rate about one axis, for a time in steps of 10 ms, the accelerometer feeling nothing but gravity.
Attitude turned(const Vec<3>& axis, double rate, double seconds) {
  Attitude attitude;
  for (int i = 1; i <= std::lround(seconds / 0.01); ++i) {
    const Eigen::Matrix3d trunk = Eigen::AngleAxisd(0.01 * i * rate, axis).toRotationMatrix();
    attitude.update({.gyro = rate * axis, .accelerometer = trunk.transpose() * Vec<3>(0, 0, gravity)}, 0.01);
  }
  return attitude;
}

}  // namespace

TEST_CASE("the filter follows quick turns by the gyroscope: roll to the right and pitch forwards are positive") {
  CHECK(turned(Vec<3>::UnitX(), 2, 0.2).roll() == doctest::Approx(0.4).epsilon(0.02));
  CHECK(std::abs(turned(Vec<3>::UnitX(), 2, 0.2).pitch()) < 1e-9);
  CHECK(turned(Vec<3>::UnitY(), 2, 0.2).pitch() == doctest::Approx(0.4).epsilon(0.02));
  CHECK(turned(Vec<3>::UnitZ(), 5, 3).up().z() == doctest::Approx(1));
  CHECK_FALSE(turned(Vec<3>::UnitY(), -2, 0.35).fallen());
  CHECK(turned(Vec<3>::UnitY(), -2, 0.45).fallen());
}

TEST_CASE("a gyroscope that is off by 0.05 rad/s leans the vertical by no more than that times the filter's second") {
  Attitude attitude;
  for (int i = 0; i < 2000; ++i) attitude.update({.gyro = {0.05, 0, 0}, .accelerometer = {0, 0, gravity}}, 0.01);
  CHECK(attitude.roll() == doctest::Approx(0.05).epsilon(0.02));
  Attitude falling;  // in free fall the accelerometer feels nothing
  for (int i = 0; i < 20; ++i) falling.update({.gyro = {0, 1, 0}}, 0.01);
  CHECK(falling.pitch() == doctest::Approx(0.2).epsilon(0.01));
}

TEST_CASE("means by phase: linear between bins, and what comes later counts more") {
  PhaseMean<1> mean;
  CHECK_FALSE(mean.known());
  for (int cycle = 0; cycle < 60; ++cycle) {
    for (int i = 0; i < 100; ++i) mean.add(i / 100.0, Vec<1>(std::sin(2 * M_PI * i / 100.0)));
  }
  CHECK(mean.known());
  for (const double phase : {0.0, 0.13, 0.25, 0.6, 0.999}) {
    CHECK(mean.at(phase)[0] == doctest::Approx(std::sin(2 * M_PI * phase)).epsilon(0.1));
  }
  for (int i = 0; i < 1000; ++i) mean.add(0.5, Vec<1>(3));
  CHECK(mean.at(0.5)[0] == doctest::Approx(3).epsilon(0.01));
}

TEST_CASE("readings from a pipe: the newest counts until it is too old, other lines are ignored") {
  const approach_program::ScratchFolder folder;
  const std::string file = folder.file("body.txt");
  std::ofstream(file) << "0.1 0.2 0.3 0 0 9.8 20 21 0.01 -0.02\nnonsense\n1 2 3\n0.4 0.2 0.3 0 0 nan 20 21 0 0\n";
  BodyReader reader(file, 0.3);
  std::optional<BodyReading> reading;
  for (int i = 0; i < 100 && !(reading && reader.ignored() == 3); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    reading = reader.feel();
  }
  REQUIRE(reading);
  CHECK(reading->gyro == Vec<3>(0.1, 0.2, 0.3));
  CHECK(reading->accelerometer.z() == 9.8);
  CHECK(reading->loads[1] == 21);
  CHECK(reading->pressure_x[1] == -0.02);
  CHECK(reader.ignored() == 3);
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  CHECK_FALSE(reader.feel());
}

TEST_CASE("an inertial unit and two feet on a bus of Protocol 1.0: signs, units, and none where one is silent") {
  using namespace dynamixel;
  std::vector<VirtualServo> devices;
  devices.emplace_back(inertial_unit, 120);
  devices.emplace_back(load_cells, 121);
  devices.emplace_back(load_cells, 122);
  devices[0].set("gyro_y", -823);  // a radian per second
  devices[0].set("accelerometer_z", 256);
  devices[1].set("cell_2", 5100);
  devices[1].set("cell_4", -50);
  devices[2].set("cell_1", 90);
  Answerer<Protocol1> answerer(devices);
  Bus<Protocol1, MemoryTransport<Protocol1>> bus(MemoryTransport<Protocol1>(answerer), {.return_delay_s = 0});
  BusSensors sensors(bus, {.newton_per_count = 0.01, .unloaded_counts = {50, 100}});
  const auto reading = sensors.feel();
  REQUIRE(reading);
  CHECK(reading->gyro.y() == doctest::Approx(-1).epsilon(0.001));
  CHECK(reading->accelerometer == Vec<3>(0, 0, 9.80665));
  CHECK(reading->loads[0] == doctest::Approx(50));
  CHECK(reading->loads[1] == doctest::Approx(-0.1));
  CHECK(reading->pressure_x[0] == doctest::Approx(0.06 * (5100 + 50) / 5000));
  CHECK(reading->pressure_x[1] == 0);
  answerer.set_silent(122, true);
  CHECK_FALSE(sensors.feel());
}

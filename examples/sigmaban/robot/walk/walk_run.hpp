// A walk to the ball by surefoot-walk: its options, and the run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "../walk_engine/spline_walk.hpp"
#include "robot_body.hpp"
#include "walk_loop.hpp"

namespace sigmaban {

/// What the command line of surefoot-walk says.
struct WalkRun {
  std::string problem = "ha", motion, policy = "expert";
  std::vector<std::string> ports = {"virtual"};
  std::string joints_file, ball_from, after = "off";
  std::vector<double> ball;
  RobotBodyOptions body;
  std::filesystem::path log;
  double rate_hz = 100, seconds = 30;
  double bus_watchdog_s = 0.5;
  bool fast_sync_read = false;
  int protocol = 2;
  std::uint32_t bits_per_s = 3'000'000;
  std::uint64_t seed = 1;
  WalkParameters walk;
};

/// How it ended.
struct WalkOutcome {
  WalkEnd end = WalkEnd::asked;
  double approach_s = 0;  // from the policy's first walk cycle until the robot stood still for one [s]
};

/// Stands up, walks to the ball, stops, and prints what happened. Throws BusError where servos or bus gave up.
WalkOutcome run_walk_to_ball(const WalkRun& options);

}  // namespace sigmaban

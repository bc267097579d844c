// A walk to the ball by surefoot-walk: its options, and the run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "../walk_engine/spline_walk.hpp"

namespace sigmaban {

/// What the command line of surefoot-walk says.
struct WalkRun {
  std::string problem = "ha", motion, policy = "expert";
  std::string port = "virtual", joints_file, ball_from, after = "off";
  std::vector<double> ball;
  std::filesystem::path log;
  double rate_hz = 100, seconds = 30;
  double bus_watchdog_s = 0.5;
  int protocol = 2;
  std::uint32_t bits_per_s = 3'000'000;
  std::uint64_t seed = 1;
  WalkParameters walk;
};

/// Stands up, walks to the ball, stops, and prints what happened.
void run_walk_to_ball(const WalkRun& options);

}  // namespace sigmaban

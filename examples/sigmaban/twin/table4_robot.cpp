#include "table4_robot.hpp"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>

#include "../../../apps/common/interrupt.hpp"

namespace sigmaban {

std::string start_in_words(const BallView& start) {
  const char* where = std::abs(start.y) < 1e-9 ? "ahead" : start.y > 0 ? "to the left" : "to the right";
  char text[96];
  std::snprintf(text, sizeof text, "ball %.1f m %s of the robot, to be kicked %s", std::hypot(start.x, start.y), where,
                std::abs(start.angle) < 1 ? "forwards" : "backwards");
  return text;
}

KickApproach walk_on_robot(const Table4Row& row, WalkRun run) {
  const BallView start = table4_starts()[static_cast<std::size_t>(row.start)];
  const bool simulated = run.ports.front() == "virtual";
  std::printf("== %s, %s, run %d: %s\n", row.problem.c_str(), row.policy.c_str(), row.run + 1,
              start_in_words(start).c_str());
  if (run.ball_from.empty()) run.ball = {start.x, start.y, start.angle};
  run.seed += static_cast<std::uint64_t>(12 * row.run + row.start);
  if (!simulated) {
    std::printf("   put the robot into its place, then press Enter\n");
    std::fflush(stdout);
    std::string line;
    if (!std::getline(std::cin, line)) throw example::Interrupted{};
  }
  const WalkOutcome outcome = run_walk_to_ball(run);
  return {.seconds = outcome.approach_s,
          .reached = outcome.end == WalkEnd::kick,
          .fell = outcome.end == WalkEnd::fell,
          .lost = outcome.end == WalkEnd::lost};
}

}  // namespace sigmaban

// Single approaches of the paper's experiment on a robot: a person puts it into its place.
#pragma once

#include "../robot/walk/walk_run.hpp"
#include "table4.hpp"

namespace sigmaban {

/// Where the ball lies and where it is to be kicked, seen from the robot: a sentence.
std::string start_in_words(const BallView& start);

/// Asks for the robot to be placed and waits for Enter, then walks. With simulated servos it waits for nobody, and the
/// ball lies where it should. Throws BusError where servos or bus gave up, example::Interrupted after Ctrl-C.
KickApproach walk_on_robot(const Table4Row& row, WalkRun run);

}  // namespace sigmaban

// Sequences whose final pose is nowhere near the model: wrong readings, most likely.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "surefoot/motion/calibrate.hpp"

namespace calibrate_program {

/// One sentence for each sequence that would be that far off once in a million. A fit that wrong readings do not decide
/// (Huber's loss) and the median of all errors are the measure, since a wrong reading makes all else look noisy.
std::vector<std::string> absurd_sequences(std::span<const surefoot::WalkSequence> sequences,
                                          const surefoot::CalibrationOptions& options);

}  // namespace calibrate_program

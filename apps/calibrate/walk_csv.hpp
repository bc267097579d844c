// The format of many sequences in one file, written.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "surefoot/motion/walk_sequence.hpp"

namespace calibrate_program {

/// The shortest text that is read back as the same number; nothing for NaN.
std::string number_text(double value);

/// seq, cycle, commands; a first line says what commands are multiplied with.
std::string commands_csv(std::span<const Eigen::Matrix3Xd> commands, double steps_per_cycle);

/// The same with poses. Sequences are numbered from 1.
std::string walks_csv(std::span<const surefoot::WalkSequence> sequences, double steps_per_cycle);

}  // namespace calibrate_program

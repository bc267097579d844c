// Picture of where sequences really ended against where they should have.
#pragma once

#include <filesystem>
#include <span>

#include "surefoot/motion/previous_command_correction.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace calibrate_program {

/// Draws BASE.svg and BASE.png: left by the commands as they are, right by the model; a line joins what belongs
/// together. `held_out`: the sequences were not fitted to. Throws example::UsageError if gnuplot is missing.
void draw_final_poses(const std::filesystem::path& base, const surefoot::PreviousCommandCorrection& model,
                      std::span<const surefoot::WalkSequence> sequences, bool held_out);

}  // namespace calibrate_program

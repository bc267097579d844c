// The calibrated walk as a model file of surefoot-diagnose.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "load_sequences.hpp"
#include "motion_file/motion_file.hpp"

namespace calibrate_program {

/// A model file (TOML, "surefoot.model/1") for recordings laid out like these. Coefficients that the commands do not
/// determine are fixed. Wheels make an ode, whose previous command is the present one. The walk's noise under the
/// commands of `sequences` goes along, so that what it always left unexplained is not taken for a change.
std::string diagnose_model(const MotionFile& file, const std::vector<bool>& determined, const FileLayout& layout,
                           const LoadOptions& options, std::span<const surefoot::WalkSequence> sequences);

}  // namespace calibrate_program

// The calibrated walk as a model file of surefoot-diagnose.
#pragma once

#include <string>
#include <vector>

#include "load_sequences.hpp"
#include "motion_file/motion_file.hpp"

namespace calibrate_program {

/// A model file (TOML, "surefoot.model/1") for recordings laid out like these. Coefficients that the commands do not
/// determine are fixed. Wheels make an ode, whose previous command is the present one.
std::string diagnose_model(const MotionFile& file, const std::vector<bool>& determined, const FileLayout& layout,
                           const LoadOptions& options);

}  // namespace calibrate_program

// Warnings about sequences whose final pose is nowhere near the model.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "surefoot/motion/calibrate.hpp"

namespace calibrate_program {

/// One sentence for each outlier (see surefoot::find_outliers); none for too few sequences to tell what is typical.
std::vector<std::string> outlier_sentences(std::span<const surefoot::WalkSequence> sequences,
                                           const surefoot::CalibrationOptions& options);

}  // namespace calibrate_program

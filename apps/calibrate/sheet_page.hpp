// The sheet to fill in with a tape measure.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>

#include "surefoot/core/box.hpp"

namespace calibrate_program {

/// A page to print: how to measure, and a row for each sequence. `space`: where the robot will walk [m].
std::string sheet_page(std::span<const Eigen::Matrix3Xd> commands, const surefoot::Box<2>& space);

/// The same to fill in on a computer.
std::string blank_sheet_csv(std::size_t sequences);

}  // namespace calibrate_program

// A sheet that was filled in, as recordings.
#pragma once

#include <cstddef>
#include <string>

#include "../diagnose/csv.hpp"

namespace calibrate_program {

struct MergedSheet {
  std::string walks;  // CSV, many sequences in one file
  std::size_t sequences = 0, skipped = 0;
};

/// Puts the poses of the sheet behind the last commands of each sequence; sequences without a position are left out.
/// Throws surefoot::MotionError that names file, line and column.
MergedSheet merge_sheet(const diagnose_program::Csv& commands, const diagnose_program::Csv& sheet);

}  // namespace calibrate_program

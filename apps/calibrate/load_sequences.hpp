// CSV files as walk sequences: many in one file (column seq, poses at the end of each row's cycle), one per file (the
// inputs of a row lead to the pose of the next), or the speeds of two wheels.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "columns.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace calibrate_program {

struct LoadOptions {
  ColumnNames columns;
  double steps_per_cycle = 0;  // 0: as the first lines of the file say
  double usual_steps = 1;      // if they say nothing
  double wheel_base = 0;       // [m], with wheels
  bool final_only = false;
  bool poses_needed = true;  // a file of commands alone is fine otherwise
};

/// How the files were read: what a model file for the same files must say.
struct FileLayout {
  Columns columns;
  bool many = false;            // in one file
  bool measured_start = false;  // the first row holds a pose
  double period = 0;            // mean time of a row, with wheels [s]
  double steps_per_cycle = 1;
};

struct LoadedSequences {
  std::vector<surefoot::WalkSequence> sequences;  // each with a final position
  std::vector<std::string> skipped;               // names of those without
  FileLayout layout;                              // of the first file
};

/// Throws surefoot::MotionError or DiagnoseError that names file, line and column.
LoadedSequences sequences_of(const diagnose_program::Csv& csv, const LoadOptions& options);

/// All files; further than that, throws if they disagree in steps per cycle or if no sequence is left.
LoadedSequences load_sequences(const std::vector<std::filesystem::path>& files, const LoadOptions& options);

/// "3 of 25 sequences have no final position and are left out: ...", or nothing.
std::string skipped_sentence(const LoadedSequences& loaded);

}  // namespace calibrate_program

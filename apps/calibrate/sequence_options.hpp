// The options that say how recordings are read and fitted, the same for several subcommands.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "../common/command.hpp"
#include "fit_walk.hpp"
#include "load_sequences.hpp"

namespace calibrate_program {

struct SequenceOptions {
  std::vector<std::filesystem::path> files;
  LoadOptions load;
  std::string method = "likelihood";
  double position_accuracy = 0.005;         // [m]
  double heading_accuracy = 0.02;           // [rad]
  std::optional<double> heading_tolerance;  // [degrees]
  std::uint64_t seed = 1;
  std::size_t threads = 0;
};

/// Everything about the files, and the files themselves.
void add_reading_options(example::Command& command, SequenceOptions& options);

/// Everything about the files, but not the files.
void add_layout_options(example::Command& command, SequenceOptions& options);

/// Accuracies and --method.
void add_fitting_options(example::Command& command, SequenceOptions& options);

/// Accuracies alone.
void add_accuracy_options(example::Command& command, SequenceOptions& options);

/// --seed and --threads.
void add_work_options(example::Command& command, SequenceOptions& options);

/// Throws UsageError for options that do not fit together.
void check(const SequenceOptions& options);

FitSettings fit_settings(const SequenceOptions& options);

/// Prints to the terminal's error stream, where progress belongs.
void say(std::string_view what);
void warn_of_skipped(const LoadedSequences& loaded);

}  // namespace calibrate_program

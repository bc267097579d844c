// Tuning as a function: what `tune` is told.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace sigmaban {

struct TuneOptions {
  std::string problem, motion;
  double budget = 50;                                     // [s] of one nominal core
  double wall = std::numeric_limits<double>::infinity();  // [s]
  std::uint64_t seed = 1;
  std::size_t threads = 0;
  std::filesystem::path out;
};

/// Writes the parameter file. Throws example::Interrupted after Ctrl-C; the best so far is kept.
void tune_winner2016(const TuneOptions& options);

}  // namespace sigmaban

// Training as a function: what `train` is told.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace sigmaban {

struct TrainOptions {
  std::string problem, motion;
  std::string preset = "default";
  double budget = 300;                                    // [s] of one nominal core
  double wall = std::numeric_limits<double>::infinity();  // [s]
  std::uint64_t seed = 1;
  std::size_t threads = 0;
  std::filesystem::path out;
  double checkpoint_seconds = 10;
  bool resume = false;

  std::filesystem::path checkpoint() const { return out.string() + ".checkpoint"; }
};

/// Writes the policy and its record. Throws example::Interrupted after Ctrl-C; the best so far is kept.
void train_on_threads(const TrainOptions& options);

}  // namespace sigmaban

// The subcommands of surefoot-twin, and the options that they share.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "../../../apps/common/usage_error.hpp"
#include "walking_twin.hpp"

namespace sigmaban {

void add_record(CLI::App& program);
void add_gains(CLI::App& program);
void add_stability(CLI::App& program);
void add_play(CLI::App& program);
void add_picture(CLI::App& program);
void add_table4(CLI::App& program);

/// Which twin, and how it is run.
struct TwinOptions {
  std::vector<std::string> switches;
  double noise = 0;         // [rad]
  bool stabilized = false;  // the walk
  std::uint64_t seed = 1;
  std::size_t threads = 0;
};

/// --switch, --noise, --stabilize, --seed, --threads.
void add_twin_options(CLI::App& command, TwinOptions& options);

/// --sequences, --cycles.
void add_sequence_options(CLI::App& command, int& sequences, int& cycles);

/// Throws TwinError for switches that there are not.
WalkingTwinOptions walking_twin_options(const TwinOptions& options);

}  // namespace sigmaban

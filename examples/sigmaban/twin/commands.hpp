// The subcommands of surefoot-twin, and the options that they share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "../../../apps/common/command.hpp"
#include "../../../apps/common/usage_error.hpp"
#include "walking_twin.hpp"

namespace sigmaban {

void add_record(example::Command& program);
void add_gains(example::Command& program);
void add_stability(example::Command& program);
void add_play(example::Command& program);
void add_picture(example::Command& program);
void add_table4(example::Command& program);

/// Which twin, and how it is run.
struct TwinOptions {
  std::vector<std::string> switches;
  double noise = 0;         // [rad]
  bool stabilized = false;  // the walk
  std::uint64_t seed = 1;
  std::size_t threads = 0;
};

/// --switch, --noise, --stabilize, --seed, --threads.
void add_twin_options(example::Command& command, TwinOptions& options);

/// --sequences, --cycles.
void add_sequence_options(example::Command& command, int& sequences, int& cycles);

/// Throws TwinError for switches that there are not.
WalkingTwinOptions walking_twin_options(const TwinOptions& options);

}  // namespace sigmaban

// Faults put into logs: each changes columns of one recording, or of all.
#pragma once

#include <string>
#include <vector>

#include "random.hpp"
#include "table.hpp"

namespace spoilt {

/// A log: the recordings of a case, and which of their columns are inputs and outputs.
struct Log {
  std::string family;
  std::vector<std::string> files;
  std::vector<Table> recordings;
  std::vector<std::size_t> inputs, outputs;  // columns; 0 is the time
  bool timed = false;                        // column 0 is in seconds, not a number of rows
};

/// What was done. An empty recording: all.
struct Spoilt {
  std::string kind, recording, channel;
  std::vector<std::string> also = {};  // other channels for which the same words would be right
  double size = 0;
};

/// The kinds, by the names that a diagnosis gives them.
const std::vector<std::string>& kinds();

/// Whether that kind can be put into this log at all.
bool possible(const Log& log, const std::string& kind);

/// Puts a fault of that kind into the log; `donor` is another machine's log of the same columns, for odd recordings.
Spoilt spoil(plants::Random& random, Log& log, const std::string& kind, const Log& donor);

}  // namespace spoilt

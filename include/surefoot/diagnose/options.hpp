// What can be chosen about a diagnosis.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/effects/named_effect.hpp"

namespace surefoot {

struct DiagnoseOptions {
  std::vector<std::string> test = {};     // names of recordings kept for the test; empty: a random share
  double test_share = 0.3;                // of the recordings, if none is named
  std::vector<std::string> effects = {};  // names of effects to consider; empty: all
  std::vector<Effect> more_effects = {};  // of the user's own
  std::vector<NamedEffect> known = {};    // part of the model already; their numbers are calibrated with the others
  int max_effects = 4;
  double max_seconds = 0;   // ends the search for effects after that long; 0: never
  std::size_t starts = 24;  // points of the global search for the nominal parameters
  /// Told what is being done, the share of the work done (0..1) and the best so far.
  std::function<void(std::string_view stage, double share, std::string_view best)> progress = {};
};

}  // namespace surefoot

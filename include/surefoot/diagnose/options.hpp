// Options of `diagnose()`.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/effects/named_effect.hpp"

namespace surefoot {

struct DiagnoseOptions {
  std::vector<std::string> held_out = {};  // names of recordings that are held out of everything; empty: see below
  double held_out_share = 0;  // [0..1] of the recordings, if none is named; 0: each is held out once (cross-fitting)
  std::vector<std::string> effects = {};   // names of effects to consider; empty: all
  std::vector<Effect> more_effects = {};   // of the user's own
  std::vector<NamedEffect> known = {};     // part of the model already; their parameters are calibrated with the others
  int max_effects = 4;                     // to combine; 0: calibrates and tests only
  double max_seconds = std::numeric_limits<double>::infinity();  // [s] since the begin, until the search ends
  bool repair = false;  // repairs faults of the log (Diagnosis::log_faults) before anything is concluded from it, and
                        // leaves out a recording unlike all others
  std::size_t max_rows = 40000;  // of all recordings together; of more, only the first rows of each are used
  std::size_t starts = 24;  // points of the global search for the nominal parameters, beside these themselves
  /// Told what is being done, the share of the work done (0..1) and the best so far.
  std::function<void(std::string_view stage, double share, std::string_view best)> on_progress = {};
};

/// Throws a DiagnoseError that names the first option that cannot be, and the cure.
void check(const DiagnoseOptions& options);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/options.ipp"
#endif

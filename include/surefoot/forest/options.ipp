// Definitions of surefoot/forest/options.hpp.
#pragma once

#include <cmath>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/options.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const ExtraTreesOptions& options) {
  auto require = [](bool good, const char* what) {
    if (!good) throw ForestError(std::string("ExtraTreesOptions: ") + what);
  };
  require(options.trees >= 1, "trees must be at least 1");
  require(options.candidates >= 0, "candidates must be at least 1, or 0 for all inputs");
  require(options.draws >= 1, "draws must be at least 1");
  require(options.min_leaf >= 1, "min_leaf must be at least 1");
  require(options.max_depth >= 0, "max_depth must be at least 1, or 0 for no limit");
  require(options.max_leaves >= 0, "max_leaves must be at least 1, or 0 for no limit");
  require(options.split_samples >= 0, "split_samples must be at least 1, or 0 for all");
  require(options.ridge >= 0 && std::isfinite(options.ridge), "ridge must be finite and at least 0");
}

}  // namespace surefoot

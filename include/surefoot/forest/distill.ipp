// Definitions of surefoot/forest/distill.hpp.
#pragma once

#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/distill.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const DistillOptions& options) {
  auto require = [](bool good, const char* what) {
    if (!good) throw ForestError(std::string("DistillOptions: ") + what);
  };
  require(options.trees >= 1, "trees must be at least 1");
  require(options.max_leaves >= 1, "max_leaves must be at least 1");
  require(options.min_leaf >= 1, "min_leaf must be at least 1");
  require(options.draws >= 1, "draws must be at least 1");
  require(options.points >= 1, "points must be at least 1");
  require(options.mixing >= 0 && options.mixing <= 1, "mixing must be 0 to 1");
}

}  // namespace surefoot

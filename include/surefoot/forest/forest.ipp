// Definitions of surefoot/forest/forest.hpp.
#pragma once

#include <cstddef>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/forest.hpp"

namespace surefoot::detail {

SUREFOOT_ONCE void fail_shape(const TreesShape& trees) {
  throw ForestError("Forest: the trees have another shape: " + trees.shape());
}

SUREFOOT_ONCE void fail_room(std::size_t trees, std::size_t leaves) {
  throw ForestError("leaf_indices: " + std::to_string(trees) + " trees, but room for " + std::to_string(leaves) +
                    " leaves");
}

}  // namespace surefoot::detail

// Forests that benchmarks share.
#pragma once

#include <cstdint>
#include <map>

#include "benchmarks/forest/data.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"

namespace surefoot::bench {

/// A forest of 25 trees with so many leaves each; trained once.
template <LeafModel Leaf, int Outputs>
const Forest<6, Outputs, Leaf>& forest_of(std::int64_t leaves) {
  static std::map<std::int64_t, Forest<6, Outputs, Leaf>> forests;
  auto [at, fresh] = forests.try_emplace(leaves);
  if (fresh) {
    at->second = train_extra_trees<Leaf>(make_samples<Outputs>(10'000 + 7 * leaves, 1),
                                         {.min_leaf = 2, .max_leaves = static_cast<int>(leaves), .model_score = false},
                                         Threads{}, 1);
  }
  return at->second;
}

}  // namespace surefoot::bench

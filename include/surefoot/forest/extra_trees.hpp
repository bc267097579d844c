// Training of extremely randomized trees: Geurts, Ernst & Wehenkel, "Extremely randomized trees", Machine
// Learning 63, 2006. A node draws one random threshold for each of K random inputs and splits at the one that lowers
// the outputs' variance most (several outputs: each in units of its own variance over all samples).
//
// Inputs that wrap around, such as angles: see wrap_around.hpp. Inputs that name categories: one input per category, 0
// or 1, since a threshold cannot choose among numbers without order.
//
// Cost per tree: O(inputs * samples * depth), all memory read in order; about 2 copies of the samples per thread.
#pragma once

#include <cstdint>
#include <stop_token>

#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/options.hpp"
#include "surefoot/forest/train/grow_forest.hpp"

namespace surefoot {

/// Trains on all samples. Tree t draws its numbers from stream t of `seed`, so the forest is the same for any executor.
/// See train_with_report for the out-of-bag error and the importance of the inputs.
template <LeafModel Leaf = ConstantLeaf, int Inputs, int Outputs, Executor E>
Forest<Inputs, Outputs, Leaf> train_extra_trees(const Dataset<Inputs, Outputs>& samples,
                                                const ExtraTreesOptions& options, const E& executor, std::uint64_t seed,
                                                std::stop_token stop = {}) {
  return Forest<Inputs, Outputs, Leaf>(detail::grow_forest<Leaf>(samples, options, executor, seed, stop).trees);
}

}  // namespace surefoot

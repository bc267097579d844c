// Growth of one extremely randomized tree; see extra_trees.hpp. One copy for all kinds of leaves and sizes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/trees.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/options.hpp"
#include "surefoot/forest/train/records.hpp"

namespace surefoot::detail {

/// Memory that one tree after the other uses: fresh memory would cost as much as a fifth of the work.
using GrowthBuffers = std::array<Records, 2>;

/// One tree or several.
struct GrownTrees {
  Trees trees;
  std::vector<double> gain;  // by which the splits of each input lowered the outputs' squared errors, in their scale
  static constexpr auto fields = std::tuple(&GrownTrees::trees, &GrownTrees::gain);
};

/// Grows one tree. `output_scale`: what a unit of squared error of each output counts.
GrownTrees grow_tree(const LeafKind& leaf, const Records& records, const RecordShape& shape,
                     std::span<const double> output_scale, const ExtraTreesOptions& options, std::uint64_t seed,
                     GrowthBuffers& buffers);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/train/tree_grower.ipp"
#endif

// Trains forests of extremely randomized trees: Geurts, Ernst & Wehenkel, "Extremely randomized trees", Machine
// Learning 63, 2006. A node draws one random threshold for each of K random inputs and splits at the one that lowers
// the outputs' variance most (several outputs: each in units of its own variance over all samples).
//
// Cost per tree: O(inputs * samples * depth), all memory read in order; about 2 copies of the samples per thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees_options.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/split.hpp"
#include "surefoot/forest/tree_grower.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot {

namespace detail {

/// Packs a data set into records.
template <int Inputs, int Outputs>
Records pack(const Dataset<Inputs, Outputs>& samples, const RecordShape& shape) {
  const auto count = static_cast<std::size_t>(samples.inputs.cols());
  Records records(count * shape.stride(), 0.0F);
  for (std::size_t i = 0; i < count; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    float* record = records.data() + i * shape.stride();
    for (int k = 0; k < shape.inputs; ++k) record[k] = samples.inputs(k, column) + 0.0F;  // -0 becomes 0
    for (int o = 0; o < shape.outputs; ++o) {
      record[shape.inputs + o] = static_cast<float>(samples.outputs(o, column));
    }
    if (shape.weighted) record[shape.weight_at()] = static_cast<float>(samples.weights[column]);
  }
  return records;
}

}  // namespace detail

/// Trains on all samples. Tree t draws its numbers from stream t of `seed`, so the forest is the same for any executor.
template <LeafModel Leaf = ConstantLeaf, int Inputs, int Outputs, Executor E>
Forest<Inputs, Outputs, Leaf> train_extra_trees(const Dataset<Inputs, Outputs>& samples,
                                                const ExtraTreesOptions& options, const E& executor, std::uint64_t seed,
                                                std::stop_token stop = {}) {
  check(samples);
  check(options);
  if (samples.inputs.rows() > max_forest_inputs) throw ForestError("a forest can have at most 255 inputs");
  if (samples.inputs.cols() > std::numeric_limits<std::int32_t>::max()) {
    throw ForestError("a forest can learn from at most 2^31 - 1 samples");
  }
  const detail::RecordShape shape{static_cast<int>(samples.inputs.rows()), static_cast<int>(samples.outputs.rows()),
                                  samples.weights.size() != 0};
  const detail::Records records = detail::pack(samples, shape);
  std::vector<double> output_scale;
  for (Eigen::Index o = 0; o < samples.outputs.rows(); ++o) {
    const double mean = samples.outputs.row(o).mean();
    const double variance = (samples.outputs.row(o).array() - mean).square().mean();
    output_scale.push_back(variance > 0 ? 1 / variance : 0.0);
  }
  const auto grown = map(
      executor, static_cast<std::size_t>(options.trees),
      [&](std::size_t tree) {
        return detail::TreeGrower<Leaf>(records, shape, output_scale, options, Rng(seed, tree).bits()).grow();
      },
      stop);
  Trees trees = grown.front();
  for (std::size_t tree = 1; tree < grown.size(); ++tree) trees.append(grown[tree]);
  return Forest<Inputs, Outputs, Leaf>(std::move(trees));
}

}  // namespace surefoot

// Trains forests of extremely randomized trees: Geurts, Ernst & Wehenkel, "Extremely randomized trees", Machine
// Learning 63, 2006. A node draws one random threshold for each of K random inputs and splits at the one that lowers
// the outputs' variance most (several outputs: each in units of its own variance over all samples).
//
// Inputs that wrap around, such as angles: see wrap_around.hpp. Inputs that name categories: one input per category, 0
// or 1, since a threshold cannot choose among numbers without order.
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
#include "surefoot/forest/options.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/train/pool.hpp"
#include "surefoot/forest/train/split.hpp"
#include "surefoot/forest/train/tree_grower.hpp"
#include "surefoot/forest/evaluate/trees.hpp"

namespace surefoot {

namespace detail {

/// The seed of one tree's random numbers.
inline std::uint64_t tree_seed(std::uint64_t seed, std::size_t tree) { return Rng(seed, tree).bits(); }

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

/// Of each output over all samples; 0 if it does not vary.
template <int Inputs, int Outputs>
std::vector<double> inverse_variances(const Dataset<Inputs, Outputs>& samples) {
  Eigen::ArrayXd share = samples.weights.array();
  if (share.size() == 0) share.setOnes(samples.inputs.cols());
  share /= share.sum();
  std::vector<double> inverse;
  for (Eigen::Index o = 0; o < samples.outputs.rows(); ++o) {
    const Eigen::ArrayXd output = samples.outputs.row(o).transpose();
    // About the first sample's, so that one that does not vary gives exactly 0.
    const Eigen::ArrayXd offset = output - output[0];
    const double variance = (share * (offset - (share * offset).sum()).square()).sum();
    inverse.push_back(variance > 0 ? 1 / variance : 0.0);
  }
  return inverse;
}

/// Does the work of train_extra_trees.
template <LeafModel Leaf, int Inputs, int Outputs, Executor E>
GrownTrees grow_forest(const Dataset<Inputs, Outputs>& samples, const ExtraTreesOptions& options, const E& executor,
                       std::uint64_t seed, std::stop_token stop) {
  check(samples);
  check(options);
  if (samples.inputs.rows() > max_forest_inputs) throw ForestError("a forest can have at most 255 inputs");
  if (samples.inputs.cols() > std::numeric_limits<std::int32_t>::max()) {
    throw ForestError("a forest can learn from at most 2^31 - 1 samples");
  }
  const RecordShape shape{static_cast<int>(samples.inputs.rows()), static_cast<int>(samples.outputs.rows()),
                          samples.weights.size() != 0};
  const Records records = pack(samples, shape);
  const std::vector<double> output_scale = inverse_variances(samples);
  Pool<GrowthBuffers> pool;
  auto grown = map(
      executor, static_cast<std::size_t>(options.trees),
      [&](std::size_t tree) {
        const auto buffers = pool.borrow();
        return TreeGrower<Leaf>(records, shape, output_scale, options, tree_seed(seed, tree), *buffers).grow();
      },
      stop);
  std::size_t nodes = 0;
  std::size_t parameters = 0;
  for (const GrownTrees& tree : grown) {
    nodes += tree.trees.nodes.size();
    parameters += tree.trees.parameters.size();
  }
  GrownTrees forest = std::move(grown.front());
  forest.trees.nodes.reserve(nodes);
  forest.trees.parameters.reserve(parameters);
  for (std::size_t tree = 1; tree < grown.size(); ++tree) {
    forest.trees.append(grown[tree].trees);
    for (std::size_t k = 0; k < forest.gain.size(); ++k) forest.gain[k] += grown[tree].gain[k];
  }
  return forest;
}

}  // namespace detail

/// Trains on all samples. Tree t draws its numbers from stream t of `seed`, so the forest is the same for any executor.
/// See train_with_report for the out-of-bag error and the importance of the inputs.
template <LeafModel Leaf = ConstantLeaf, int Inputs, int Outputs, Executor E>
Forest<Inputs, Outputs, Leaf> train_extra_trees(const Dataset<Inputs, Outputs>& samples,
                                                const ExtraTreesOptions& options, const E& executor, std::uint64_t seed,
                                                std::stop_token stop = {}) {
  return Forest<Inputs, Outputs, Leaf>(detail::grow_forest<Leaf>(samples, options, executor, seed, stop).trees);
}

}  // namespace surefoot

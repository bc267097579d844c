// Definitions of surefoot/forest/train/grow_forest.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/train/grow_forest.hpp"

namespace surefoot::detail {

/// Packs a data set into records.
inline Records pack(const DatasetView& samples, const RecordShape& shape) {
  const auto count = static_cast<std::size_t>(samples.count);
  Records records(count * shape.stride(), 0.0F);
  const float* input = samples.inputs;
  const double* output = samples.outputs;
  for (std::size_t i = 0; i < count; ++i) {
    float* record = records.data() + i * shape.stride();
    for (int k = 0; k < shape.inputs; ++k) record[k] = *input++ + 0.0F;  // -0 becomes 0
    for (int o = 0; o < shape.outputs; ++o) record[shape.inputs + o] = static_cast<float>(*output++);
    if (shape.weighted) record[shape.weight_at()] = static_cast<float>(samples.weights[i]);
  }
  return records;
}

SUREFOOT_ONCE TrainingSet training_set(const DatasetView& samples, const ExtraTreesOptions& options) {
  check(options);
  if (samples.input_rows > max_forest_inputs) throw ForestError("a forest can have at most 255 inputs");
  if (samples.count > std::numeric_limits<std::int32_t>::max()) {
    throw ForestError("a forest can learn from at most 2^31 - 1 samples");
  }
  const RecordShape shape{static_cast<int>(samples.input_rows), static_cast<int>(samples.output_rows),
                          samples.weights != nullptr};
  return {shape, pack(samples, shape), inverse_variances(samples)};
}

SUREFOOT_ONCE GrownTrees join(std::vector<GrownTrees> grown) {
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

}  // namespace surefoot::detail

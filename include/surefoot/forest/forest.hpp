// Regression forest: the mean of many trees, each piecewise constant or linear.
//
// Cost of one prediction: about trees * depth steps of one comparison each, branch-free and several trees at a time;
// no allocation. The sum over the trees is always taken in their order, so every way to predict gives the same bits.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "surefoot/core/vec.hpp"
#include "surefoot/forest/descend.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot {

/// A trained forest. Inputs and Outputs may be Eigen::Dynamic. Made by train_extra_trees or load.
template <int Inputs, int Outputs, LeafModel Leaf = ConstantLeaf>
class Forest {
 public:
  static_assert(Inputs == Eigen::Dynamic || (Inputs > 0 && Inputs <= max_forest_inputs), "1 to 255 inputs");
  using Batch = Eigen::Matrix<float, Inputs, Eigen::Dynamic>;
  using BatchOutput = Eigen::Matrix<double, Outputs, Eigen::Dynamic>;

  /// An empty forest: it has a shape only, and must not predict.
  Forest() {
    trees_.inputs = std::max(Inputs, 0);
    trees_.outputs = std::max(Outputs, 0);
    trees_.leaf_parameters = Leaf::parameters(trees_.inputs, trees_.outputs);
  }

  /// Takes trees over; throws ForestError if their shape is not that of this type.
  explicit Forest(Trees trees) : trees_(std::move(trees)) {
    if ((Inputs != Eigen::Dynamic && trees_.inputs != Inputs) ||
        (Outputs != Eigen::Dynamic && trees_.outputs != Outputs) ||
        trees_.leaf_parameters != Leaf::parameters(trees_.inputs, trees_.outputs)) {
      throw ForestError("Forest: the trees have another shape: " + trees_.shape());
    }
  }

  bool empty() const { return trees_.roots.empty(); }
  int inputs() const { return Inputs != Eigen::Dynamic ? Inputs : trees_.inputs; }
  int outputs() const { return Outputs != Eigen::Dynamic ? Outputs : trees_.outputs; }
  std::size_t trees() const { return trees_.roots.size(); }
  std::size_t leaves() const { return trees_.leaves; }
  std::size_t bytes() const {
    return trees_.nodes.size() * sizeof(Node) + trees_.parameters.size() * sizeof(float) +
           trees_.roots.size() * sizeof(std::uint32_t);
  }
  const Trees& raw() const { return trees_; }

  /// The forest's output for one input; the input is rounded to float first.
  Vec<Outputs> predict(const Vec<Inputs>& x) const {
    std::array<float, input_room> rounded;
    for (int k = 0; k < inputs(); ++k) rounded[static_cast<std::size_t>(k)] = static_cast<float>(x[k]);
    Vec<Outputs> out = Vec<Outputs>::Zero(outputs());
    add_one(rounded.data(), out.data());
    return out *= scale();
  }

  /// One output column per input column. Allocates nothing if `out` has the right size already. Fastest if neighbouring
  /// columns are neighbours in space too: what their paths have in common is walked once for up to 256 of them.
  void predict(const Eigen::Ref<const Batch>& batch, BatchOutput& out) const {
    out.resize(outputs(), batch.cols());
    if (batch.colStride() == batch.rows()) {
      predict(batch.data(), static_cast<std::size_t>(batch.cols()), out.data());
    } else {
      for (Eigen::Index i = 0; i < batch.cols(); ++i) {
        predict(batch.data() + i * batch.colStride(), 1, out.data() + i * outputs());
      }
    }
  }

  /// `count` inputs, one behind the other, to `count` outputs, one behind the other.
  void predict(const float* inputs, std::size_t count, double* out) const {
    const auto width = static_cast<std::size_t>(this->outputs());
    const auto stride = static_cast<std::size_t>(this->inputs());
    std::fill_n(out, count * width, 0.0);
    while (count > 0) {
      const std::size_t samples = std::min(count, block_size());
      add_block(inputs, samples, out);
      for (std::size_t i = 0; i < samples * width; ++i) out[i] *= scale();
      inputs += samples * stride;
      out += samples * width;
      count -= samples;
    }
  }

  bool operator==(const Forest&) const = default;

 private:
  static constexpr std::size_t input_room = static_cast<std::size_t>(Inputs > 0 ? Inputs : max_forest_inputs);
  static constexpr std::size_t fixed_stride = Inputs > 0 ? input_room + 1 : 0;
  static constexpr std::size_t tree_block = 64;  // trees descended before their leaves are summed
  static constexpr std::size_t max_block = 256;  // samples that go through the trees together
  static constexpr std::size_t key_room = 2048;  // their sort keys: 16 kB, half of a small L1 cache

  double scale() const { return 1.0 / static_cast<double>(trees_.roots.size()); }
  std::size_t block_size() const {
    const std::size_t rows = key_room / (static_cast<std::size_t>(inputs()) + 1);
    return std::min(rows / detail::lanes * detail::lanes, max_block);
  }

  static constexpr bool fixed_size = Inputs != Eigen::Dynamic && Outputs != Eigen::Dynamic;
  static constexpr bool always_inline_leaves = fixed_size && Leaf::parameters(Inputs, Outputs) == 1;
  static constexpr bool never_inline_leaves = fixed_size && !always_inline_leaves;

  void add_leaf(std::uint32_t payload, const float* x, double* sum) const {
    if constexpr (!never_inline_leaves) {
      if (always_inline_leaves || trees_.inline_leaves()) {
        const auto parameter = std::bit_cast<float>(payload);
        Leaf::add(&parameter, x, inputs(), outputs(), sum);
        return;
      }
    }
    if constexpr (!always_inline_leaves) {
      Leaf::add(trees_.parameters.data() + payload * trees_.leaf_parameters, x, inputs(), outputs(), sum);
    }
  }

  void add_one(const float* x, double* sum) const {
    std::array<std::uint32_t, input_room> keys;
    std::array<std::uint32_t, tree_block> payloads;
    const auto width = static_cast<std::size_t>(inputs());
    for (std::size_t k = 0; k < width; ++k) keys[k] = sort_key(x[k]);
    for (std::size_t first = 0; first < trees(); first += tree_block) {
      const auto roots = roots_from(first);
      detail::find_leaves(trees_.nodes.data(), roots, std::span(keys).first(width), payloads.data());
      for (std::size_t t = 0; t < roots.size(); ++t) add_leaf(payloads[t], x, sum);
    }
  }

  void add_block(const float* x, std::size_t count, double* sum) const {
    std::array<std::uint64_t, key_room> keys;
    std::array<std::uint64_t, input_room + 1> low;
    std::array<std::uint64_t, input_room + 1> high;
    std::array<const Node*, tree_block> partings;
    std::array<std::uint32_t, max_block> payloads;
    const auto in = static_cast<std::size_t>(inputs());
    const auto out = static_cast<std::size_t>(outputs());
    const std::size_t stride = in + 1;
    low.fill(~std::uint64_t{0});
    high.fill(0);
    low[in] = 0;
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t* key = keys.data() + i * stride;
      for (std::size_t k = 0; k < in; ++k) {
        key[k] = std::uint64_t{sort_key(x[i * in + k])} << 32;
        low[k] = std::min(low[k], key[k]);
        high[k] = std::max(high[k], key[k]);
      }
      key[in] = 0;
    }
    const std::size_t filled_up = (count + detail::lanes - 1) / detail::lanes * detail::lanes;
    std::fill(keys.data() + count * stride, keys.data() + filled_up * stride, 0);
    for (std::size_t first = 0; first < trees(); first += tree_block) {
      const auto roots = roots_from(first);
      detail::find_parting(trees_.nodes.data(), roots, low.data(), high.data(), partings.data());
      for (std::size_t t = 0; t < roots.size(); ++t) {
        detail::find_leaves_of_batch<fixed_stride>(partings[t], keys.data(), stride, count, payloads.data());
        for (std::size_t i = 0; i < count; ++i) add_leaf(payloads[i], x + i * in, sum + i * out);
      }
    }
  }

  std::span<const std::uint32_t> roots_from(std::size_t first) const {
    return std::span(trees_.roots).subspan(first, std::min(tree_block, trees() - first));
  }

  Trees trees_;
};

/// One forest with all the trees of several of equal shape: predicts their mean, weighted by their numbers of trees.
template <int Inputs, int Outputs, LeafModel Leaf>
Forest<Inputs, Outputs, Leaf> merge(std::span<const Forest<Inputs, Outputs, Leaf>> forests) {
  if (forests.empty()) throw ForestError("merge: needs at least one forest");
  Trees joined = forests[0].raw();
  for (const auto& forest : forests.subspan(1)) joined.append(forest.raw());
  return Forest<Inputs, Outputs, Leaf>(std::move(joined));
}

}  // namespace surefoot

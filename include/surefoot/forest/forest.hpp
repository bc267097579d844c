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
#include <type_traits>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/forest/evaluate/blocks.hpp"
#include "surefoot/forest/evaluate/descend.hpp"
#include "surefoot/forest/evaluate/descend_batch.hpp"
#include "surefoot/forest/evaluate/descend_blocks.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot {

/// What the trees of a forest say together: their mean, and for each output the root of their mean squared distance
/// from it (0 for a single tree). Large where the forest has seen little or the function is steep: a doubt, not an
/// error bound.
template <int Outputs>
struct MeanAndDeviation {
  Vec<Outputs> mean;
  Vec<Outputs> deviation;
};

namespace detail {

[[noreturn]] void fail_shape(const TreesShape& trees);
[[noreturn]] void fail_room(std::size_t trees, std::size_t leaves);

}  // namespace detail

/// A trained forest. Inputs and Outputs may be Eigen::Dynamic. Made by train_extra_trees or load. `Storage` has the
/// trees: its own, or (ForestView) those that lie elsewhere.
template <int Inputs, int Outputs, LeafModel Leaf = ConstantLeaf, class Storage = Trees>
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

  /// Takes trees over; throws ForestError if their shape is not that of this type. Of a large forest a second layout
  /// is made, for single predictions: O(nodes) time, and three quarters of the nodes' bytes.
  explicit Forest(Storage trees) : trees_(std::move(trees)) {
    if ((Inputs != Eigen::Dynamic && trees_.inputs != Inputs) ||
        (Outputs != Eigen::Dynamic && trees_.outputs != Outputs) ||
        trees_.leaf_parameters != Leaf::parameters(trees_.inputs, trees_.outputs)) {
      detail::fail_shape(trees_);
    }
    if constexpr (std::is_same_v<Storage, Trees>) {
      if (detail::blocks_pay(trees_)) blocks_ = detail::make_blocks(trees_);
    }
  }

  bool empty() const { return trees_.roots.empty(); }
  int inputs() const { return Inputs != Eigen::Dynamic ? Inputs : trees_.inputs; }
  int outputs() const { return Outputs != Eigen::Dynamic ? Outputs : trees_.outputs; }
  std::size_t trees() const { return trees_.roots.size(); }
  std::size_t leaves() const { return trees_.leaves; }
  /// Of nodes, leaves and roots: what a file takes.
  std::size_t bytes() const {
    return trees_.nodes.size() * sizeof(Node) + trees_.parameters.size() * sizeof(float) +
           trees_.roots.size() * sizeof(std::uint32_t);
  }
  const Storage& raw() const { return trees_; }

  /// The forest's output for one input; the input is rounded to float first.
  Vec<Outputs> predict(const Vec<Inputs>& x) const {
    const Rounded rounded = round(x);
    Vec<Outputs> out = Vec<Outputs>::Zero(outputs());
    if (trees() == 1) {
      add_lone_tree(rounded.data(), out.data());
      return out;
    }
    add_one(rounded.data(), out.data());
    return out *= scale();
  }

  /// The output for one input, the same bits as those of predict, and how far the trees are apart. Allocates nothing if
  /// the number of outputs is fixed.
  MeanAndDeviation<Outputs> predict_with_deviation(const Vec<Inputs>& x) const {
    const Rounded rounded = round(x);
    Vec<Outputs> sum = Vec<Outputs>::Zero(outputs());
    Vec<Outputs> squares = Vec<Outputs>::Zero(outputs());  // squared distances from the mean (Welford 1962)
    Vec<Outputs> one = Vec<Outputs>::Zero(outputs());
    Vec<Outputs> mean = Vec<Outputs>::Zero(outputs());
    double count = 0;
    visit_leaves(rounded.data(), [&](std::span<const std::uint32_t> payloads) {
      for (const std::uint32_t payload : payloads) {
        one.setZero();
        add_leaf(payload, rounded.data(), one.data());
        sum += one;
        count += 1;
        for (int o = 0; o < outputs(); ++o) {
          const double distance = one[o] - mean[o];
          mean[o] += distance / count;
          squares[o] += distance * (one[o] - mean[o]);
        }
      }
    });
    return {sum * scale(), (squares * scale()).cwiseSqrt()};
  }

  /// Which leaf one input reaches in each tree: entry t is the leaf's index in raw().nodes, so no two trees share one.
  /// For tables of one's own about leaves, and for how alike two inputs are (the share of trees where they share a
  /// leaf). Allocates nothing. Throws ForestError unless `leaves` has room for exactly as many as there are trees.
  void leaf_indices(const Vec<Inputs>& x, std::span<std::uint32_t> leaves) const {
    if (leaves.size() != trees()) {
      detail::fail_room(trees(), leaves.size());
    }
    const Rounded rounded = round(x);
    const Keys keys = wide_keys(rounded.data());
    const Node* nodes = trees_.nodes.data();
    detail::find_leaves_portable(nodes, trees_.roots, used(keys), [&](std::size_t tree, const Node* leaf) {
      leaves[tree] = static_cast<std::uint32_t>(leaf - nodes);
    });
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
      if (samples < few) {
        for (std::size_t i = 0; i < samples; ++i) add_one(inputs + i * stride, out + i * width);
      } else {
        add_block(inputs, samples, out, width, 0);
      }
      for (std::size_t i = 0; i < samples * width; ++i) out[i] *= scale();
      inputs += samples * stride;
      out += samples * width;
      count -= samples;
    }
  }

  /// As above, but what each tree says by itself: trees() * outputs() numbers per input, tree after tree.
  void predict_trees(const float* inputs, std::size_t count, double* out) const {
    const std::size_t width = static_cast<std::size_t>(this->outputs()),
                      stride = static_cast<std::size_t>(this->inputs());
    std::fill_n(out, count * width * trees(), 0.0);
    while (count > 0) {
      const std::size_t samples = std::min(count, block_size());
      if (samples < few) {
        for (std::size_t i = 0; i < samples; ++i) {
          double* to = out + i * trees() * width;
          visit_leaves(inputs + i * stride, [&](std::span<const std::uint32_t> payloads) {
            for (const std::uint32_t payload : payloads) {
              add_leaf(payload, inputs + i * stride, to);
              to += width;
            }
          });
        }
      } else {
        add_block(inputs, samples, out, trees() * width, width);
      }
      inputs += samples * stride;
      out += samples * width * trees();
      count -= samples;
    }
  }

  bool operator==(const Forest&) const = default;

 private:
  static constexpr std::size_t input_room = static_cast<std::size_t>(Inputs > 0 ? Inputs : max_forest_inputs);
  static constexpr std::size_t fixed_stride = Inputs > 0 ? input_room + 1 : 0;
  static constexpr std::size_t tree_block = detail::most_in_flight;  // trees descended before their leaves are summed
  static constexpr std::size_t key_room = 2048;  // sort keys of the samples that go through a tree together: 24 kB
  static constexpr std::size_t few = 32;         // fewer samples are faster one by one

  double scale() const { return 1.0 / static_cast<double>(trees_.roots.size()); }
  std::size_t block_size() const {
    const std::size_t rows = key_room / (static_cast<std::size_t>(inputs()) + 1);
    return std::min(rows / detail::lanes * detail::lanes, detail::max_batch);
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

  using Rounded = std::array<float, input_room>;
  using Keys = std::array<std::uint64_t, input_room + 1>;

  Rounded round(const Vec<Inputs>& x) const {
    Rounded rounded;
    for (int k = 0; k < inputs(); ++k) rounded[static_cast<std::size_t>(k)] = static_cast<float>(x[k]);
    return rounded;
  }
  Keys wide_keys(const float* x) const {
    Keys keys;
    for (std::size_t k = 0; k < static_cast<std::size_t>(inputs()); ++k) keys[k] = wide_key(x[k]);
    keys[static_cast<std::size_t>(inputs())] = 0;
    return keys;
  }
  std::span<const std::uint64_t> used(const Keys& keys) const {
    return std::span(keys).first(static_cast<std::size_t>(inputs()) + 1);
  }

  /// Calls visit(payloads) for the leaves in all trees, some trees at a time and in their order.
  template <class Visit>
  void visit_leaves(const float* x, const Visit& visit) const {
    const Keys keys = wide_keys(x);
    std::array<std::uint32_t, tree_block> payloads;
    for (std::size_t first = 0; first < trees(); first += tree_block) {
      const auto roots = roots_from(first);
      if (blocks_.roots.empty()) {
        detail::find_leaves(std::span<const Node>(trees_.nodes), roots, used(keys), payloads.data());
      } else {
        detail::find_leaves_in_blocks(blocks_.blocks, std::span(blocks_.roots).subspan(first, roots.size()), used(keys),
                                      payloads.data());
      }
      visit(std::span<const std::uint32_t>(payloads).first(roots.size()));
    }
  }

  /// Not inlined, where compilers would run short of registers and keep the sum in memory.
  [[gnu::noinline]] void add_leaves(std::span<const std::uint32_t> payloads, const float* x, double* sum) const {
    if constexpr (Outputs > 0 && Outputs <= 8) {
      std::array<double, static_cast<std::size_t>(Outputs)> local;
      std::copy_n(sum, Outputs, local.begin());
      for (const std::uint32_t payload : payloads) add_leaf(payload, x, local.data());
      std::copy_n(local.begin(), Outputs, sum);
    } else {
      for (const std::uint32_t payload : payloads) add_leaf(payload, x, sum);
    }
  }

  /// What add_one does if there is one tree, in half the time where that is small.
  void add_lone_tree(const float* x, double* sum) const {
    const Keys keys = wide_keys(x);
    const Node* node = trees_.nodes.data() + trees_.roots[0];
    detail::move_all([&](const Node* at, std::size_t) { return at->step(keys.data()); }, node);
    add_leaf(node->payload(), x, sum);
  }

  void add_one(const float* x, double* sum) const {
    visit_leaves(x, [&](std::span<const std::uint32_t> payloads) { add_leaves(payloads, x, sum); });
  }

  /// What a tree says of an input is added to sum + input * input_stride + tree * tree_stride.
  void add_block(const float* x, std::size_t count, double* sum, std::size_t input_stride,
                 std::size_t tree_stride) const {
    std::array<std::uint64_t, key_room> rows;
    std::array<std::int32_t, key_room> columns;
    std::array<std::uint64_t, input_room + 1> low;
    std::array<std::uint64_t, input_room + 1> high;
    std::array<const Node*, tree_block> partings;
    std::array<std::uint32_t, detail::max_batch> payloads;
    const auto in = static_cast<std::size_t>(inputs());
    const detail::BatchKeys keys{rows.data(), in + 1, columns.data(), block_size()};
    const std::size_t padded = (count + detail::lanes - 1) / detail::lanes * detail::lanes;
    low[in] = high[in] = 0;
    std::fill(rows.data() + count * keys.stride, rows.data() + padded * keys.stride, 0);
    for (std::size_t i = 0; i < count; ++i) rows[i * keys.stride + in] = 0;
    std::fill_n(columns.data() + in * keys.length, padded, detail::flipped(0));
    for (std::size_t k = 0; k < in; ++k) {
      std::uint32_t lowest = ~std::uint32_t{0};
      std::uint32_t highest = 0;
      std::int32_t* column = columns.data() + k * keys.length;
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t key = sort_key(x[i * in + k]);
        rows[i * keys.stride + k] = std::uint64_t{key} << 32;
        column[i] = detail::flipped(key);
        lowest = std::min(lowest, key);
        highest = std::max(highest, key);
      }
      std::fill(column + count, column + padded, detail::flipped(0));
      low[k] = std::uint64_t{lowest} << 32;
      high[k] = std::uint64_t{highest} << 32;
    }
    for (std::size_t first = 0; first < trees(); first += tree_block) {
      const auto roots = roots_from(first);
      detail::find_parting(trees_.nodes.data(), roots, low.data(), high.data(), partings.data());
      for (std::size_t t = 0; t < roots.size(); ++t) {
        detail::find_leaves_of_batch<fixed_stride>(partings[t], keys, count, payloads.data());
        double* to = sum + (first + t) * tree_stride;
        for (std::size_t i = 0; i < count; ++i) add_leaf(payloads[i], x + i * in, to + i * input_stride);
      }
    }
  }

  std::span<const std::uint32_t> roots_from(std::size_t first) const {
    return std::span(trees_.roots).subspan(first, std::min(tree_block, trees() - first));
  }

  Storage trees_;
  detail::Blocks blocks_;  // the same trees; empty where they would not be faster
};

/// A forest used where its bytes lie, without a copy: see `view`. Predicts what the Forest does.
template <int Inputs, int Outputs, LeafModel Leaf = ConstantLeaf>
using ForestView = Forest<Inputs, Outputs, Leaf, TreesView>;

/// One forest with all the trees of several of equal shape: predicts their mean, weighted by their numbers of trees.
template <int Inputs, int Outputs, LeafModel Leaf>
Forest<Inputs, Outputs, Leaf> merge(std::span<const Forest<Inputs, Outputs, Leaf>> forests) {
  if (forests.empty()) throw ForestError("merge: needs at least one forest");
  Trees joined = forests[0].raw();
  for (const auto& forest : forests.subspan(1)) joined.append(forest.raw());
  return Forest<Inputs, Outputs, Leaf>(std::move(joined));
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/forest.ipp"
#endif

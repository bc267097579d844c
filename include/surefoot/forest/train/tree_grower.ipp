// Definitions of surefoot/forest/train/tree_grower.hpp.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/evaluate/layout.hpp"
#include "surefoot/forest/train/bootstrap.hpp"
#include "surefoot/forest/train/end_ranks.hpp"
#include "surefoot/forest/train/linear_score.hpp"
#include "surefoot/forest/train/split.hpp"
#include "surefoot/forest/train/tree_grower.hpp"

namespace surefoot::detail {

/// Grows one tree.
class TreeGrower {
 public:
  TreeGrower(const LeafKind& leaf, const Records& records, const RecordShape& shape,
             std::span<const double> output_scale, const ExtraTreesOptions& options, std::uint64_t seed,
             GrowthBuffers& buffers)
      : leaf_(leaf),
        records_(records),
        shape_(shape),
        output_scale_(output_scale),
        options_(options),
        buffers_(buffers),
        rng_(seed),
        stride_(shape.stride()),
        count_(records.size() / stride_),
        low_(stride_),
        high_(stride_),
        mean_(stride_),
        thresholds_(stride_),
        gain_(static_cast<std::size_t>(shape.inputs)),
        sums_(shape) {
    if (leaf.linear && options.model_score) linear_.emplace(shape);
  }

  GrownTrees grow() {
    for (Records& buffer : buffers_) buffer.resize(records_.size());
    if (options_.bootstrap) {
      float* to = buffers_[0].data();
      draw_bootstrap(rng_, count_, [&](std::size_t from) {
        std::copy_n(records_.data() + from * stride_, stride_, to);
        to += stride_;
      });
    }
    trees_.inputs = shape_.inputs;
    trees_.outputs = shape_.outputs;
    trees_.leaf_parameters = leaf_.parameters(shape_.inputs, shape_.outputs);
    tree_.push_back({});
    add(find_split({0, 0, count_, 0}));
    const bool best_first = options_.max_leaves > 0;
    std::size_t leaves = 1;
    while (!open_.empty()) {
      if (best_first) {
        if (leaves >= static_cast<std::size_t>(options_.max_leaves)) break;
        std::pop_heap(open_.begin(), open_.end());
      }
      const Open open = open_.back();
      open_.pop_back();
      split(open);
      ++leaves;
    }
    for (const Open& open : open_) make_leaf(open);
    trees_.nodes = lay_out(tree_, shape_.inputs);
    trees_.roots = {0};
    return {std::move(trees_), std::move(gain_)};
  }

 private:
  /// A node that waits to be split, with its best split.
  struct Open {
    std::uint32_t node = 0;
    std::size_t begin = 0;  // its records
    std::size_t end = 0;
    int depth = 0;
    int input = -1;  // of the split; -1: none found, or none allowed
    float threshold = 0;
    double gain = 0;
    bool operator<(const Open& other) const { return gain < other.gain || (gain == other.gain && node > other.node); }
  };

  // Records of depth d lie in buffer d % 2; the root's, unless drawn, are those of the data set itself.
  RecordSpan span(const Open& open) const {
    const bool original = open.depth == 0 && !options_.bootstrap;
    const Records& home = original ? records_ : buffers_[static_cast<std::size_t>(open.depth % 2)];
    return {home.data() + open.begin * stride_, open.end - open.begin, stride_};
  }

  void add(const Open& open) {
    if (open.input < 0) {
      make_leaf(open);
      return;
    }
    open_.push_back(open);
    if (options_.max_leaves > 0) std::push_heap(open_.begin(), open_.end());
  }

  void make_leaf(const Open& open) {
    const RecordSpan records = span(open);
    const std::size_t size = trees_.leaf_parameters;
    const LeafSamples samples(records.first, records.count, stride_, shape_.inputs, shape_.outputs, shape_.weighted);
    parameters_.resize(size);
    leaf_.fit(samples, LeafOptions{options_.ridge, options_.clamp}, parameters_);
    if (size == 1) {
      tree_[open.node].payload = std::bit_cast<std::uint32_t>(parameters_[0]);
    } else {
      tree_[open.node].payload = static_cast<std::uint32_t>(trees_.leaves);
      trees_.parameters.insert(trees_.parameters.end(), parameters_.cbegin(), parameters_.cend());
    }
    ++trees_.leaves;
  }

  void split(const Open& open) {
    Records& to = buffers_[static_cast<std::size_t>((open.depth + 1) % 2)];
    const std::size_t left_count =
        partition(span(open), static_cast<std::size_t>(open.input), open.threshold, to.data() + open.begin * stride_);
    const std::size_t middle = open.begin + left_count;
    gain_[static_cast<std::size_t>(open.input)] += std::max(open.gain, 0.0);
    const auto left = static_cast<std::uint32_t>(tree_.size());
    GrownNode& node = tree_[open.node];
    node.input = open.input;
    node.threshold = open.threshold;
    node.left = left;
    tree_.resize(tree_.size() + 2);
    add(find_split({left, open.begin, middle, open.depth + 1}));
    add(find_split({left + 1, middle, open.end, open.depth + 1}));
  }

  Open find_split(Open open) {
    const RecordSpan records = span(open);
    tree_[open.node].count = static_cast<std::uint32_t>(records.count);
    if (records.count < 2 * static_cast<std::size_t>(options_.min_leaf)) return open;
    if (options_.max_depth > 0 && open.depth >= options_.max_depth) return open;
    find_range(records, low_.data(), high_.data(), mean_.data());
    const std::size_t y = shape_.output_at();
    const auto outputs = static_cast<std::size_t>(shape_.outputs);
    if (std::equal(&low_[y], &low_[y] + outputs, &high_[y])) return open;  // all outputs the same: nothing to gain
    choose_inputs();
    if (options_.threshold_rule == ThresholdRule::uniform) {
      for (int draw = 0; draw < options_.draws; ++draw) {
        for (const int input : chosen_) draw_uniform(input);
        score(records, open);
      }
      if (open.input >= 0) return open;
    }
    for (int draw = 0; draw < options_.draws; ++draw) {  // the other rule's last resort as well
      for (const int input : chosen_) draw_balanced(records, input);
      score(records, open);
    }
    return open;
  }

  // K of the inputs that vary in the node.
  void choose_inputs() {
    chosen_.clear();
    for (int k = 0; k < shape_.inputs; ++k) {
      if (low_[static_cast<std::size_t>(k)] < high_[static_cast<std::size_t>(k)]) chosen_.push_back(k);
    }
    const auto wanted = static_cast<std::size_t>(options_.candidates);
    if (wanted != 0 && wanted < chosen_.size()) {
      for (std::size_t i = 0; i < wanted; ++i) {
        std::swap(chosen_[i], chosen_[i + rng_.below(static_cast<std::uint32_t>(chosen_.size() - i))]);
      }
      chosen_.resize(wanted);
    }
    std::fill(thresholds_.begin(), thresholds_.end(), -std::numeric_limits<float>::infinity());
  }

  void draw_between(int input, float low, float high) {
    const double at =
        static_cast<double>(low) + rng_.uniform() * (static_cast<double>(high) - static_cast<double>(low));
    const float threshold = static_cast<float>(at) + 0.0F;
    thresholds_[static_cast<std::size_t>(input)] = threshold < high ? threshold : low;
  }

  void draw_uniform(int input) {
    draw_between(input, low_[static_cast<std::size_t>(input)], high_[static_cast<std::size_t>(input)]);
  }

  void draw_balanced(const RecordSpan& records, int input) {
    const auto k = static_cast<std::size_t>(input);
    const auto [low, high] = ranks_.find(records, k, low_[k], high_[k], static_cast<std::size_t>(options_.min_leaf));
    if (low < high) draw_between(input, low, high);
  }

  // Sets the split of `open` to the best of the candidates that leave min_leaf samples on both sides, if it has none
  // that is as good.
  void score(const RecordSpan& records, Open& open) {
    if (linear_) {
      score_fits(records, open);
    } else {
      score_variance(records, open);
    }
  }

  static double gain_of(const Open& open) {
    return open.input < 0 ? -std::numeric_limits<double>::infinity() : open.gain;
  }

  // Every so many of the records that affine fits are scored on.
  std::size_t score_step(std::size_t count) const {
    const auto most = static_cast<std::size_t>(options_.split_samples);
    return most == 0 ? 1 : std::max<std::size_t>(1, count / most);
  }

  static std::size_t count_left(const RecordSpan& records, std::size_t input, float threshold) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < records.count; ++i) count += records[i][input] <= threshold ? 1U : 0U;
    return count;
  }

  void score_fits(const RecordSpan& records, Open& open) {
    const std::size_t step = score_step(records.count);
    const RecordSpan some{records.first, (records.count + step - 1) / step, records.stride * step};
    linear_->measure(some, chosen_, thresholds_.data(), low_.data(), high_.data(), mean_.data());
    const double together = linear_->explained_together(output_scale_, options_.ridge);
    const auto fewest = static_cast<std::size_t>(options_.min_leaf);
    double best = gain_of(open);
    for (std::size_t c = 0; c < chosen_.size(); ++c) {
      const std::size_t scored_left = linear_->left_count(c);
      if (scored_left == 0 || scored_left == some.count) continue;
      const double gain =
          (linear_->explained_apart(c, output_scale_, options_.ridge) - together) * static_cast<double>(step);
      if (!(gain > best)) continue;
      const auto input = static_cast<std::size_t>(chosen_[c]);
      const std::size_t left_count = step == 1 ? scored_left : count_left(records, input, thresholds_[input]);
      if (left_count < fewest || records.count - left_count < fewest) continue;
      best = gain;
      open.input = chosen_[c];
      open.threshold = thresholds_[input];
      open.gain = gain;
    }
  }

  void score_variance(const RecordSpan& records, Open& open) {
    sum_left(records, shape_, thresholds_.data(), &mean_[shape_.output_at()], sums_);
    const std::size_t width = 4 * shape_.input_quads();
    const auto count = static_cast<std::int64_t>(records.count);
    double best = gain_of(open);
    for (const int input : chosen_) {
      const auto k = static_cast<std::size_t>(input);
      const std::int64_t left_count = sums_.count[k];
      if (left_count < options_.min_leaf || count - left_count < options_.min_leaf) continue;
      const double left_weight = sums_.weight[k];
      const double right_weight = sums_.total_weight - left_weight;
      double gain = 0;
      for (std::size_t o = 0; o < sums_.total.size(); ++o) {
        const double left = sums_.output[o * width + k];
        const double right = sums_.total[o] - left;
        gain += output_scale_[o] * (left * left / left_weight + right * right / right_weight -
                                    sums_.total[o] * sums_.total[o] / sums_.total_weight);
      }
      if (gain > best) {
        best = gain;
        open.input = input;
        open.threshold = thresholds_[k];
        open.gain = gain;
      }
    }
  }

  const LeafKind& leaf_;
  const Records& records_;
  RecordShape shape_;
  std::span<const double> output_scale_;
  const ExtraTreesOptions& options_;
  GrowthBuffers& buffers_;
  FastRng rng_;
  std::size_t stride_;
  std::size_t count_;
  std::vector<GrownNode> tree_;
  std::vector<Open> open_;
  Trees trees_;
  std::vector<float> low_, high_, mean_, thresholds_, parameters_;
  std::vector<int> chosen_;
  std::vector<double> gain_;
  EndRanks ranks_;
  std::optional<LinearScore> linear_;
  LeftSums sums_;
};

SUREFOOT_INLINE GrownTrees grow_tree(const LeafKind& leaf, const Records& records, const RecordShape& shape,
                                     std::span<const double> output_scale, const ExtraTreesOptions& options,
                                     std::uint64_t seed, GrowthBuffers& buffers) {
  return TreeGrower(leaf, records, shape, output_scale, options, seed, buffers).grow();
}

}  // namespace surefoot::detail

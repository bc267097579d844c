// Distillation: one tree, or a few, that do what a whole forest does, learned from the forest's answers at as many
// points as wanted. After Breiman & Shang, "Born again trees", 1996.
//
// The tree is grown best first. A node is split as the best of many one-split extra-trees would, by the squared error
// that is left: a lone tree cannot average bad splits away, so it is worth looking for good ones.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/loose_tree.hpp"
#include "surefoot/forest/unexplained.hpp"

namespace surefoot {

struct DistillOptions {
  int trees = 1;
  int max_leaves = 64;    // per tree
  int min_leaf = 8;       // fewest points in a leaf
  int draws = 24;         // thresholds tried for each input at each split
  int points = 40'000;    // that the forest is asked at, per tree
  double mixing = 0.5;    // chance of each input of a point to come from another sample, 0..1
  LeafOptions leaf = {};  // how leaves are fitted
};

/// Throws a ForestError that names the field and its range.
inline void check(const DistillOptions& options) {
  auto require = [](bool good, const char* what) {
    if (!good) throw ForestError(std::string("DistillOptions: ") + what);
  };
  require(options.trees >= 1, "trees must be at least 1");
  require(options.max_leaves >= 1, "max_leaves must be at least 1");
  require(options.min_leaf >= 1, "min_leaf must be at least 1");
  require(options.draws >= 1, "draws must be at least 1");
  require(options.points >= 1, "points must be at least 1");
  require(options.mixing >= 0 && options.mixing <= 1, "mixing must be 0 to 1");
}

template <int Inputs, int Outputs, LeafModel Leaf>
struct Distilled {
  Forest<Inputs, Outputs, Leaf> forest;
  double loss = 0;  // share of the variance of the larger forest's answers at fresh points that is lost; 0: none
};

/// Points where the data is, and the forest's answers there: each is a sample's input, but every component comes from
/// another random sample with probability `mixing`. 0: the samples themselves; 1: any combination of their values, for
/// evenly spread samples the whole box.
template <int Inputs, int Outputs, LeafModel Teacher>
Dataset<Inputs, Outputs> ask(const Forest<Inputs, Outputs, Teacher>& forest,
                             const Eigen::Matrix<float, Inputs, Eigen::Dynamic>& inputs, Eigen::Index points,
                             double mixing, Rng rng) {
  if (inputs.cols() == 0 || inputs.rows() != forest.inputs()) {
    throw ForestError("ask: needs at least one sample with the forest's " + std::to_string(forest.inputs()) +
                      " inputs");
  }
  const auto any = [&] {
    const auto count = static_cast<double>(inputs.cols());
    return std::min(static_cast<Eigen::Index>(rng.uniform() * count), inputs.cols() - 1);
  };
  Dataset<Inputs, Outputs> asked;
  asked.inputs.resize(inputs.rows(), points);
  for (Eigen::Index i = 0; i < points; ++i) {
    const Eigen::Index from = any();
    for (Eigen::Index k = 0; k < inputs.rows(); ++k) {
      asked.inputs(k, i) = inputs(k, rng.uniform() < mixing ? any() : from);
    }
  }
  forest.predict(asked.inputs, asked.outputs);
  return asked;
}

namespace detail {

/// Grows one tree best first from the best of many random splits.
template <LeafModel Leaf, int Inputs, int Outputs, Executor E>
class StumpGrower {
 public:
  using Data = Dataset<Inputs, Outputs>;

  StumpGrower(const DistillOptions& options, const E& executor, Rng rng)
      : options_(options), executor_(executor), rng_(rng) {}

  LooseTree grow(Data data) {
    scale_ = inverse_variances(data);
    tree_ = loosen(train(data, 1, 1).raw(), 0);
    open_.push_back(find_split(0, std::move(data)));
    for (int leaves = 1; leaves < options_.max_leaves; ++leaves) {
      const auto best =
          std::max_element(open_.begin(), open_.end(), [](const Open& a, const Open& b) { return a.gain < b.gain; });
      if (!(best->gain > 0)) break;
      const Open open = std::move(*best);
      open_.erase(best);
      split(open);
    }
    return std::move(tree_);
  }

 private:
  struct Open {  // a leaf, and the best split of it
    std::uint32_t node;
    Data data;
    LooseTree stump;
    double gain = 0;  // of squared error
  };

  Forest<Inputs, Outputs, Leaf> train(const Data& data, int trees, int leaves) {
    ExtraTreesOptions options;
    options.trees = trees;
    options.max_leaves = leaves;
    options.min_leaf = std::min(options_.min_leaf, static_cast<int>(data.inputs.cols()));
    options.ridge = options_.leaf.ridge;
    options.clamp = options_.leaf.clamp;
    return train_extra_trees<Leaf>(data, options, executor_, rng_.bits());
  }

  double squared_error(const LooseTree& tree, const Data& data) const {
    const auto outputs = static_cast<int>(data.outputs.rows());
    const auto inputs = static_cast<int>(data.inputs.rows());
    const std::size_t width = Leaf::parameters(inputs, outputs);
    std::vector<double> sum(scale_.size());
    double error = 0;
    for (Eigen::Index i = 0; i < data.inputs.cols(); ++i) {
      std::size_t node = 0;
      if (!tree.nodes[0].is_leaf()) {  // one split at most
        node = tree.nodes[0].left + (data.inputs(tree.nodes[0].input, i) > tree.nodes[0].threshold ? 1U : 0U);
      }
      std::fill(sum.begin(), sum.end(), 0.0);
      Leaf::add(tree.numbers.data() + node * width, data.inputs.col(i).data(), inputs, outputs, sum.data());
      for (int o = 0; o < outputs; ++o) {
        const auto at = static_cast<std::size_t>(o);
        error += scale_[at] * std::pow(sum[at] - data.outputs(o, i), 2);
      }
    }
    return error;
  }

  Open find_split(std::uint32_t node, Data data) {
    Open open{node, std::move(data), {}, 0};
    if (open.data.inputs.cols() < 2 * static_cast<Eigen::Index>(options_.min_leaf)) return open;
    const std::size_t width = tree_.numbers.size() / tree_.nodes.size();
    const auto own = tree_.numbers.begin() + static_cast<std::ptrdiff_t>(node * width);
    const LooseTree leaf{{GrownNode{}}, {own, own + static_cast<std::ptrdiff_t>(width)}};
    const double error = squared_error(leaf, open.data);
    if (!(error > 0)) return open;
    const auto stumps = train(open.data, options_.draws, 2);
    const auto tries = map(executor_, stumps.trees(), [&](std::size_t i) {
      LooseTree stump = loosen(stumps.raw(), i);
      const double gain = stump.nodes[0].is_leaf() ? 0 : error - squared_error(stump, open.data);
      return std::pair(gain, std::move(stump));
    });
    for (const auto& [gain, stump] : tries) {
      if (gain <= open.gain) continue;
      open.gain = gain;
      open.stump = stump;
    }
    return open;
  }

  void split(const Open& open) {
    const GrownNode top = open.stump.nodes[0];
    const auto left = static_cast<std::uint32_t>(tree_.nodes.size());
    const std::size_t width = open.stump.numbers.size() / open.stump.nodes.size();
    tree_.nodes[open.node] = {top.threshold, top.input, left, 0, 0};
    tree_.numbers.insert(tree_.numbers.end(), open.stump.numbers.begin() + static_cast<std::ptrdiff_t>(width),
                         open.stump.numbers.end());
    tree_.nodes.resize(tree_.nodes.size() + 2);
    std::array<std::vector<Eigen::Index>, 2> sides;
    for (Eigen::Index i = 0; i < open.data.inputs.cols(); ++i) {
      sides[open.data.inputs(top.input, i) > top.threshold ? 1 : 0].push_back(i);
    }
    tree_.nodes[open.node].count = static_cast<std::uint32_t>(open.data.inputs.cols());
    for (std::uint32_t child = 0; child < 2; ++child) {
      const std::vector<Eigen::Index>& mine = sides[child];
      tree_.nodes[left + child].count = static_cast<std::uint32_t>(mine.size());
      open_.push_back(
          find_split(left + child, {open.data.inputs(Eigen::all, mine), open.data.outputs(Eigen::all, mine), {}}));
    }
  }

  DistillOptions options_;
  const E& executor_;
  Rng rng_;
  std::vector<double> scale_;
  LooseTree tree_;
  std::vector<Open> open_;
};

}  // namespace detail

/// Learns a smaller forest, with `Leaf` leaves, from the forest's answers around `inputs` (one sample per column: where
/// it will be used). The result is the same for any executor. Throws ForestError if the forest is empty or an option is
/// out of range. Time: about that of training trees * draws * 4 trees on `points` samples.
template <LeafModel Leaf = LinearLeaf, int Inputs, int Outputs, LeafModel Teacher, Executor E>
Distilled<Inputs, Outputs, Leaf> distill(const Forest<Inputs, Outputs, Teacher>& forest,
                                         const Eigen::Matrix<float, Inputs, Eigen::Dynamic>& inputs,
                                         const DistillOptions& options, const E& executor, std::uint64_t seed) {
  check(options);
  if (forest.empty()) throw ForestError("distill: the forest is empty, train or load it first");
  Trees trees = detail::without_trees(forest.raw());
  trees.leaf_parameters = Leaf::parameters(forest.inputs(), forest.outputs());
  for (int tree = 0; tree < options.trees; ++tree) {
    const auto points = ask(forest, inputs, options.points, options.mixing, Rng(seed, tree, 0));
    detail::StumpGrower<Leaf, Inputs, Outputs, E> grower(options, executor, Rng(seed, tree, 1));
    detail::fasten(grower.grow(points), trees);
  }
  Distilled<Inputs, Outputs, Leaf> result{Forest<Inputs, Outputs, Leaf>(std::move(trees)), 0};
  const auto fresh = ask(forest, inputs, std::max(1000, options.points / 4), options.mixing, Rng(seed, 0, 2));
  result.loss = unexplained(result.forest, fresh);
  return result;
}

}  // namespace surefoot

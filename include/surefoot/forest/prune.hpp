// Makes a forest smaller: fewer trees, or fewer leaves in each by cost-complexity pruning (Breiman, Friedman, Olshen &
// Stone, "Classification and Regression Trees", 1984, ch. 3).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/train/loose_tree.hpp"
#include "surefoot/forest/train/unexplained_variance.hpp"

namespace surefoot {

/// A forest of some of the trees of another, in the order given; a tree may come more than once.
template <int Inputs, int Outputs, LeafModel Leaf>
Forest<Inputs, Outputs, Leaf> keep_trees(const Forest<Inputs, Outputs, Leaf>& forest,
                                         std::span<const std::size_t> trees) {
  if (trees.empty()) throw ForestError("keep_trees: needs at least one tree");
  Trees kept = detail::without_trees(forest.raw());
  for (const std::size_t tree : trees) {
    if (tree >= forest.trees()) {
      throw ForestError("keep_trees: there is no tree " + std::to_string(tree) + ", the forest has " +
                        std::to_string(forest.trees()));
    }
    detail::fasten(detail::loosen(forest.raw(), tree), kept);
  }
  return Forest<Inputs, Outputs, Leaf>(std::move(kept));
}

/// The trees whose mean fits the samples best, chosen one after the other, so the first n of them are also the choice
/// for n (forward selection; Caruana et al. 2004). `count` of them, 1 to all. Time: O(trees * count * samples); memory:
/// the predictions of every tree. Use samples that the forest has not learned from.
template <int Inputs, int Outputs, LeafModel Leaf>
std::vector<std::size_t> best_trees(const Forest<Inputs, Outputs, Leaf>& forest,
                                    const Dataset<Inputs, Outputs>& samples, std::size_t count) {
  detail::check_fit(forest, samples, "best_trees");
  if (count < 1 || count > forest.trees()) {
    throw ForestError("best_trees: count must be 1 to " + std::to_string(forest.trees()) + ", got " +
                      std::to_string(count));
  }
  const std::vector<double> scale = detail::inverse_variances(samples);
  Eigen::ArrayXXd weights(samples.outputs.rows(), samples.outputs.cols());  // of each squared error
  for (Eigen::Index o = 0; o < weights.rows(); ++o) weights.row(o).setConstant(scale[static_cast<std::size_t>(o)]);
  if (samples.weights.size() != 0) weights.rowwise() *= samples.weights.transpose().array();
  std::vector<typename Forest<Inputs, Outputs, Leaf>::BatchOutput> predicted(forest.trees());
  for (std::size_t tree = 0; tree < forest.trees(); ++tree) {
    keep_trees(forest, std::span<const std::size_t>(&tree, 1)).predict(samples.inputs, predicted[tree]);
  }
  std::vector<std::size_t> chosen;
  Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(weights.rows(), weights.cols());
  while (chosen.size() < count) {
    const double share = 1 / static_cast<double>(chosen.size() + 1);
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t tree = 0; tree < forest.trees(); ++tree) {
      if (std::find(chosen.begin(), chosen.end(), tree) != chosen.end()) continue;
      const double error =
          (weights * ((sum + predicted[tree].array()) * share - samples.outputs.array()).square()).sum();
      if (error < least) {
        least = error;
        best = tree;
      }
    }
    chosen.push_back(best);
    sum += predicted[best].array();
  }
  return chosen;
}

namespace detail {

/// A step of weakest-link pruning: an inner node becomes a leaf.
struct Collapse {
  double cost = 0;  // added squared error per leaf saved; never less than that of the step before
  std::uint32_t node = 0;
  std::size_t leaves = 0;  // saved
  static constexpr auto fields = std::tuple(&Collapse::cost, &Collapse::node, &Collapse::leaves);
};

/// Works out in what order the inner nodes of one tree become leaves, and with which numbers.
template <LeafModel Leaf, int Inputs, int Outputs>
class TreePruner {
 public:
  TreePruner(LooseTree tree, const Dataset<Inputs, Outputs>& samples, std::span<const double> output_scale,
             const LeafOptions& options)
      : tree_(std::move(tree)),
        samples_(samples),
        scale_(output_scale),
        options_(options),
        inputs_(static_cast<int>(samples.inputs.rows())),
        outputs_(static_cast<int>(samples.outputs.rows())),
        width_(Leaf::parameters(inputs_, outputs_)),
        risk_(tree_.nodes.size(), 0.0) {}

  /// The tree with numbers at all inner nodes, and all steps down to the root alone.
  std::pair<LooseTree, std::vector<Collapse>> work() {
    fit_nodes();
    std::vector<Collapse> steps = order();
    return {std::move(tree_), std::move(steps)};
  }

 private:
  // Sends the samples down, fits a leaf model at every inner node (leaves keep theirs) and sums its squared errors.
  void fit_nodes() {
    struct Visit {
      std::uint32_t node;
      std::size_t begin, end;  // of the samples that come here
    };
    std::vector<Eigen::Index> order(static_cast<std::size_t>(samples_.inputs.cols()));
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
    std::vector<Visit> open{{0, 0, order.size()}};
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      GrownNode& node = tree_.nodes[visit.node];
      node.count = static_cast<std::uint32_t>(visit.end - visit.begin);
      const auto mine = std::span(order).subspan(visit.begin, visit.end - visit.begin);
      fit(visit.node, mine);
      if (node.is_leaf()) continue;
      for (std::uint32_t child = node.left; child <= node.left + 1; ++child) {
        if (tree_.nodes[child].is_leaf()) continue;  // where no sample comes, what is above holds
        std::copy_n(numbers(visit.node), width_, numbers(child));
      }
      auto middle = mine.begin();  // the left ones move there in order, the right ones follow in order
      to_the_right_.clear();
      for (const Eigen::Index i : mine) {
        if (samples_.inputs(node.input, i) > node.threshold) {
          to_the_right_.push_back(i);
        } else {
          *middle++ = i;
        }
      }
      std::copy(to_the_right_.begin(), to_the_right_.end(), middle);
      const std::size_t parting = visit.begin + static_cast<std::size_t>(middle - mine.begin());
      open.push_back({node.left, visit.begin, parting});
      open.push_back({node.left + 1, parting, visit.end});
    }
  }

  void fit(std::uint32_t node, std::span<const Eigen::Index> mine) {
    if (mine.empty()) return;
    const bool weighted = samples_.weights.size() != 0;
    const auto stride = static_cast<std::size_t>(inputs_ + outputs_ + (weighted ? 1 : 0));
    records_.resize(mine.size() * stride);
    float* record = records_.data();
    for (const Eigen::Index i : mine) {
      for (int k = 0; k < inputs_; ++k) *record++ = samples_.inputs(k, i);
      for (int o = 0; o < outputs_; ++o) *record++ = static_cast<float>(samples_.outputs(o, i));
      if (weighted) *record++ = static_cast<float>(samples_.weights[i]);
    }
    const LeafSamples leaf_samples(records_.data(), mine.size(), stride, inputs_, outputs_, weighted);
    if (!tree_.nodes[node].is_leaf()) Leaf::fit(leaf_samples, options_, std::span(numbers(node), width_));
    predicted_.resize(static_cast<std::size_t>(outputs_));
    for (std::size_t i = 0; i < mine.size(); ++i) {
      std::fill(predicted_.begin(), predicted_.end(), 0.0);
      Leaf::add(numbers(node), leaf_samples.input(i), inputs_, outputs_, predicted_.data());
      for (std::size_t o = 0; o < predicted_.size(); ++o) {
        const double error = predicted_[o] - static_cast<double>(leaf_samples.output(i)[o]);
        risk_[node] += leaf_samples.weight(i) * scale_[o] * error * error;
      }
    }
  }

  float* numbers(std::uint32_t node) { return tree_.numbers.data() + node * width_; }

  std::vector<Collapse> order() const {
    const std::vector<GrownNode>& nodes = tree_.nodes;
    std::vector<double> below(risk_);  // squared error of the leaves below each node
    std::vector<std::size_t> leaves(nodes.size(), 1);
    std::vector<std::uint32_t> parent(nodes.size(), 0);
    for (std::size_t i = nodes.size(); i-- > 0;) {
      if (nodes[i].is_leaf()) continue;
      const std::uint32_t left = nodes[i].left;
      parent[left] = parent[left + 1] = static_cast<std::uint32_t>(i);
      below[i] = below[left] + below[left + 1];
      leaves[i] = leaves[left] + leaves[left + 1];
    }
    const auto link = [&](std::uint32_t i) {
      return std::pair((risk_[i] - below[i]) / static_cast<double>(leaves[i] - 1), i);
    };
    std::set<std::pair<double, std::uint32_t>> links;
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
      if (!nodes[i].is_leaf()) links.insert(link(i));
    }
    std::vector<Collapse> steps;
    std::vector<std::uint32_t> open;
    while (!links.empty()) {
      const auto [cost, weakest] = *links.begin();
      const double never_less = steps.empty() ? cost : std::max(cost, steps.back().cost);
      steps.push_back({never_less, weakest, leaves[weakest] - 1});
      open.assign(1, weakest);
      while (!open.empty()) {  // it and all below are links no more
        const std::uint32_t i = open.back();
        open.pop_back();
        if (leaves[i] == 1) continue;
        links.erase(link(i));
        if (i != weakest) leaves[i] = 1;
        open.push_back(nodes[i].left);
        open.push_back(nodes[i].left + 1);
      }
      const std::size_t saved = leaves[weakest] - 1;
      const double added = risk_[weakest] - below[weakest];
      leaves[weakest] = 1;
      for (std::uint32_t i = weakest; i != 0;) {
        i = parent[i];
        links.erase(link(i));
        below[i] += added;
        leaves[i] -= saved;
        links.insert(link(i));
      }
    }
    return steps;
  }

  LooseTree tree_;
  const Dataset<Inputs, Outputs>& samples_;
  std::span<const double> scale_;
  LeafOptions options_;
  int inputs_;
  int outputs_;
  std::size_t width_;
  std::vector<double> risk_;  // of each node as a leaf: its samples' squared errors in units of the outputs' variance
  std::vector<Eigen::Index> to_the_right_;
  std::vector<float> records_;
  std::vector<double> predicted_;
};

}  // namespace detail

/// Prunes all trees by one measure until Forest::bytes() is at most `bytes`: again and again the inner node becomes a
/// leaf that adds the least squared error on the samples per leaf saved; its leaf is fitted to the samples there. Other
/// leaves stay as they are. Give at least as many samples as the forest was trained on, the same ones or others.
/// `options`: how leaves are fitted. Throws ForestError if even single leaves take more. Time: a leaf fit to the
/// samples per level of each tree.
template <int Inputs, int Outputs, LeafModel Leaf, Executor E = Serial>
Forest<Inputs, Outputs, Leaf> prune(const Forest<Inputs, Outputs, Leaf>& forest,
                                    const Dataset<Inputs, Outputs>& samples, std::size_t bytes,
                                    const LeafOptions& options = {}, const E& executor = {}) {
  detail::check_fit(forest, samples, "prune");
  const std::size_t width = forest.raw().leaf_parameters;
  const std::size_t least = forest.trees() * detail::tree_bytes(1, width);
  if (least > bytes) {
    throw ForestError("prune: " + std::to_string(forest.trees()) + " trees take at least " + std::to_string(least) +
                      " bytes, asked for " + std::to_string(bytes) + "; keep fewer trees");
  }
  if (forest.bytes() <= bytes) return forest;
  const std::vector<double> scale = detail::inverse_variances(samples);
  auto pruned = map(executor, forest.trees(), [&](std::size_t tree) {
    return detail::TreePruner<Leaf, Inputs, Outputs>(detail::loosen(forest.raw(), tree), samples, scale, options)
        .work();
  });
  struct Step {
    double cost;
    std::size_t tree, number;
    bool operator<(const Step& other) const {
      return cost < other.cost || (cost == other.cost && std::pair(tree, number) < std::pair(other.tree, other.number));
    }
  };
  std::vector<Step> steps;
  std::vector<std::size_t> leaves;
  std::size_t estimate = 0;
  for (std::size_t tree = 0; tree < pruned.size(); ++tree) {
    leaves.push_back(1);
    for (std::size_t i = 0; i < pruned[tree].second.size(); ++i) {
      steps.push_back({pruned[tree].second[i].cost, tree, i});
      leaves[tree] += pruned[tree].second[i].leaves;
    }
    estimate += detail::tree_bytes(leaves[tree], width);
  }
  std::sort(steps.begin(), steps.end());
  auto step = steps.begin();
  for (std::size_t target = bytes;;) {
    for (; estimate > target; ++step) {
      const detail::Collapse& collapse = pruned[step->tree].second[step->number];
      pruned[step->tree].first.nodes[collapse.node].left = 0;
      estimate -= detail::tree_bytes(leaves[step->tree], width);
      leaves[step->tree] -= collapse.leaves;
      estimate += detail::tree_bytes(leaves[step->tree], width);
    }
    Trees trees = detail::without_trees(forest.raw());
    for (const auto& tree : pruned) detail::fasten(tree.first, trees);
    Forest<Inputs, Outputs, Leaf> smaller(std::move(trees));
    if (smaller.bytes() <= bytes) return smaller;
    target = estimate - std::min(estimate - least, smaller.bytes() - bytes);  // the lines that lay_out could not fill
  }
}

}  // namespace surefoot

// Definitions of surefoot/forest/shrink/tree_pruner.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/shrink/tree_pruner.hpp"

namespace surefoot::detail {

/// Works out in what order the inner nodes of one tree become leaves, and with which numbers.
class TreePruner {
 public:
  TreePruner(const LeafKind& leaf, LooseTree tree, const DatasetView& samples, std::span<const double> output_scale,
             const LeafOptions& options)
      : leaf_(leaf),
        tree_(std::move(tree)),
        samples_(samples),
        scale_(output_scale),
        options_(options),
        inputs_(static_cast<int>(samples.input_rows)),
        outputs_(static_cast<int>(samples.output_rows)),
        width_(leaf_.parameters(inputs_, outputs_)),
        risk_(tree_.nodes.size(), 0.0) {}

  /// The tree with numbers at all inner nodes, and all steps down to the root alone.
  PrunedTree work() {
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
    std::vector<Eigen::Index> order(static_cast<std::size_t>(samples_.count));
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
        if (samples_.inputs[i * inputs_ + node.input] > node.threshold) {
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
    const bool weighted = samples_.weights != nullptr;
    const auto stride = static_cast<std::size_t>(inputs_ + outputs_ + (weighted ? 1 : 0));
    records_.resize(mine.size() * stride);
    float* record = records_.data();
    for (const Eigen::Index i : mine) {
      for (int k = 0; k < inputs_; ++k) *record++ = samples_.inputs[i * inputs_ + k];
      for (int o = 0; o < outputs_; ++o) *record++ = static_cast<float>(samples_.outputs[i * outputs_ + o]);
      if (weighted) *record++ = static_cast<float>(samples_.weights[i]);
    }
    const LeafSamples leaf_samples(records_.data(), mine.size(), stride, inputs_, outputs_, weighted);
    if (!tree_.nodes[node].is_leaf()) leaf_.fit(leaf_samples, options_, std::span(numbers(node), width_));
    predicted_.resize(static_cast<std::size_t>(outputs_));
    for (std::size_t i = 0; i < mine.size(); ++i) {
      std::fill(predicted_.begin(), predicted_.end(), 0.0);
      leaf_.add(numbers(node), leaf_samples.input(i), inputs_, outputs_, predicted_.data());
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

  LeafKind leaf_;
  LooseTree tree_;
  DatasetView samples_;
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

SUREFOOT_INLINE PrunedTree weakest_links(const LeafKind& leaf, LooseTree tree, const DatasetView& samples,
                                         std::span<const double> output_scale, const LeafOptions& options) {
  return TreePruner(leaf, std::move(tree), samples, output_scale, options).work();
}

/// A step of one of the trees.
struct PruningStep {
  double cost;
  std::size_t tree, number;
  bool operator<(const PruningStep& other) const {
    return cost < other.cost || (cost == other.cost && std::pair(tree, number) < std::pair(other.tree, other.number));
  }
};
inline std::size_t trees_bytes(const Trees& trees) {
  return trees.nodes.size() * sizeof(Node) + trees.parameters.size() * sizeof(float) +
         trees.roots.size() * sizeof(std::uint32_t);
}

SUREFOOT_ONCE Trees collapse_to(std::vector<PrunedTree> pruned, const Trees& like, std::size_t bytes) {
  const std::size_t width = like.leaf_parameters;
  const std::size_t least = pruned.size() * tree_bytes(1, width);
  std::vector<PruningStep> steps;
  std::vector<std::size_t> leaves;
  std::size_t estimate = 0;
  for (std::size_t tree = 0; tree < pruned.size(); ++tree) {
    leaves.push_back(1);
    for (std::size_t i = 0; i < pruned[tree].second.size(); ++i) {
      steps.push_back({pruned[tree].second[i].cost, tree, i});
      leaves[tree] += pruned[tree].second[i].leaves;
    }
    estimate += tree_bytes(leaves[tree], width);
  }
  std::sort(steps.begin(), steps.end());
  auto step = steps.begin();
  for (std::size_t target = bytes;;) {
    for (; estimate > target; ++step) {
      const Collapse& collapse = pruned[step->tree].second[step->number];
      pruned[step->tree].first.nodes[collapse.node].left = 0;
      estimate -= tree_bytes(leaves[step->tree], width);
      leaves[step->tree] -= collapse.leaves;
      estimate += tree_bytes(leaves[step->tree], width);
    }
    Trees trees = without_trees(like);
    for (const auto& tree : pruned) fasten(tree.first, trees);
    const std::size_t taken = trees_bytes(trees);
    if (taken <= bytes) return trees;
    target = estimate - std::min(estimate - least, taken - bytes);  // the lines that lay_out could not fill
  }
}

}  // namespace surefoot::detail

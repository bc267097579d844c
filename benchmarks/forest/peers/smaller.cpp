// Smaller forests of linear leaves of this library: pruned, one tree distilled from a forest, one tree alone.
#include <algorithm>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <utility>

#include "surefoot.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/forest/distill.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/options.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/prune.hpp"
#include "surefoot_model.hpp"

namespace peers {
namespace {

using surefoot::LinearLeaf;

constexpr int most_leaves = 2000;  // of the distilled tree; more would need more points than the forest is asked at

surefoot::ExtraTreesOptions options_for(const Size& size) {
  return {.trees = size.trees,
          .min_leaf = size.min_leaf,
          .max_leaves = size.leaves,
          .threshold_rule = surefoot::ThresholdRule::balanced};
}

/// What is done to the samples to get a forest of `size`.
struct Prune {
  template <int Outputs>
  auto operator()(const surefoot::Dataset<width, Outputs>& data, const Size& size) const {
    constexpr int surplus = 4;  // times the wanted leaves are grown and then pruned
    const surefoot::Threads threads(size.threads);
    auto options = options_for(size);
    options.max_leaves *= surplus;
    const auto forest = surefoot::train_extra_trees<LinearLeaf>(data, options, threads, 1);
    const std::size_t per_leaf = 2 * sizeof(surefoot::Node) + LinearLeaf::parameters(width, Outputs) * sizeof(float);
    const auto leaves = static_cast<std::size_t>(size.trees) * static_cast<std::size_t>(size.leaves);
    return surefoot::prune(forest, data, leaves * per_leaf, {}, threads);
  }
};

struct Distill {
  template <int Outputs>
  auto operator()(const surefoot::Dataset<width, Outputs>& data, const Size& size) const {
    const surefoot::Threads threads(size.threads);
    auto options = options_for({.leaves = most_leaves, .min_leaf = 10});
    const auto forest = surefoot::train_extra_trees<LinearLeaf>(data, options, threads, 1);
    return surefoot::distill(forest, data.inputs, {.max_leaves = std::min(size.leaves, most_leaves)}, threads, 1)
        .forest;
  }
};

struct OneTree {
  template <int Outputs>
  auto operator()(const surefoot::Dataset<width, Outputs>& data, const Size& size) const {
    auto options = options_for(size);
    options.trees = 1;
    options.draws = surefoot::DistillOptions{}.draws;
    return surefoot::train_extra_trees<LinearLeaf>(data, options, surefoot::Serial{}, 1);
  }
};

template <int Outputs, class Make>
std::unique_ptr<Model> model(const Samples& samples, const Size& size, const Make& make) {
  return std::make_unique<Surefoot<Outputs, LinearLeaf>>(make(data_of<Outputs>(samples), size));
}

template <class Make>
std::unique_ptr<Model> train(const Samples& samples, const Size& size, const Make& make) {
  switch (samples.outputs) {
    case 1:
      return model<1>(samples, size, make);
    case 3:
      return model<3>(samples, size, make);
    default:
      throw std::invalid_argument("smaller forests of 1 or 3 outputs only");
  }
}

}  // namespace

std::unique_ptr<Model> train_pruned(const Samples& samples, const Size& size) { return train(samples, size, Prune{}); }
std::unique_ptr<Model> train_distilled(const Samples& samples, const Size& size) {
  return train(samples, size, Distill{});
}
std::unique_ptr<Model> train_one_tree(const Samples& samples, const Size& size) {
  return train(samples, size, OneTree{});
}

}  // namespace peers

// One linear-leaf tree of this library, distilled from a forest.
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "surefoot.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/forest/distill.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot_model.hpp"

namespace peers {
namespace {

constexpr int most_leaves = 2000;  // more would need more points than the forest is asked at

template <int Outputs>
std::unique_ptr<Model> train(const Samples& samples, const Size& size) {
  const auto data = data_of<Outputs>(samples);
  const surefoot::Threads threads(size.threads);
  const auto forest = surefoot::train_extra_trees<surefoot::LinearLeaf>(
      data, {.min_leaf = 10, .max_leaves = most_leaves, .threshold_rule = surefoot::ThresholdRule::balanced}, threads,
      1);
  auto tree = surefoot::distill(forest, data.inputs, {.max_leaves = std::min(size.leaves, most_leaves)}, threads, 1);
  return std::make_unique<Surefoot<Outputs, surefoot::LinearLeaf>>(std::move(tree.forest));
}

}  // namespace

std::unique_ptr<Model> train_distilled(const Samples& samples, const Size& size) {
  switch (samples.outputs) {
    case 1:
      return train<1>(samples, size);
    case 3:
      return train<3>(samples, size);
    default:
      throw std::invalid_argument("a distilled tree of 1 or 3 outputs only");
  }
}

}  // namespace peers

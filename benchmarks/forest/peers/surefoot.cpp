// Compiled twice: as it is, and with SUREFOOT_PORTABLE and the namespace surefoot renamed, so that both can be linked.
#include "surefoot.hpp"

#include <memory>
#include <stdexcept>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot_model.hpp"

namespace peers {
namespace {

template <int Outputs, class Leaf>
std::unique_ptr<Model> train(const Samples& samples, const Size& size) {
  surefoot::ExtraTreesOptions options{.trees = size.trees, .min_leaf = size.min_leaf, .max_leaves = size.leaves};
  if (size.balanced) options.threshold_rule = surefoot::ThresholdRule::balanced;
  return std::make_unique<Surefoot<Outputs, Leaf>>(
      surefoot::train_extra_trees<Leaf>(data_of<Outputs>(samples), options, surefoot::Threads(size.threads), 1));
}

template <class Leaf>
std::unique_ptr<Model> train(const Samples& samples, const Size& size) {
  switch (samples.outputs) {
    case 1:
      return train<1, Leaf>(samples, size);
    case 3:
      return train<3, Leaf>(samples, size);
    case 6:
      return train<6, Leaf>(samples, size);
    default:
      throw std::invalid_argument("forests of 1, 3 or 6 outputs only");
  }
}

}  // namespace

#ifdef SUREFOOT_PORTABLE
std::unique_ptr<Model> train_constant_portable(const Samples& samples, const Size& size) {
  return train<surefoot::ConstantLeaf>(samples, size);
}
std::unique_ptr<Model> train_linear_portable(const Samples& samples, const Size& size) {
  return train<surefoot::LinearLeaf>(samples, size);
}
#else
std::unique_ptr<Model> train_constant(const Samples& samples, const Size& size) {
  return train<surefoot::ConstantLeaf>(samples, size);
}
std::unique_ptr<Model> train_linear(const Samples& samples, const Size& size) {
  return train<surefoot::LinearLeaf>(samples, size);
}
#endif

}  // namespace peers

// Training that also tells which inputs mattered and, with bootstrap, how large the error on new samples will be.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <utility>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/options.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/train/out_of_bag.hpp"

namespace surefoot {

template <int Inputs, int Outputs, LeafModel Leaf>
struct ReportedForest {
  Forest<Inputs, Outputs, Leaf> forest;

  /// Per input: the share of its splits in all that the splits lowered the outputs' squared errors by (each output in
  /// units of its variance), about what scikit-learn calls feature_importances_. The sum is 1, or 0 if nothing was
  /// split. Inputs without influence get a little, more the smaller min_leaf is: their splits fit noise
  /// (permutation_importance on other samples does not have this flaw). Linear leaves: what slopes explain is no
  /// split's gain, so an input that acts linearly may get little.
  Eigen::VectorXd importance;

  std::optional<OutOfBagError> out_of_bag;  // if options.bootstrap
};

/// train_extra_trees, the same forest to the bit, with a report. The importance costs nothing; the out-of-bag error
/// about as much as predicting each sample with 37 % of the trees.
template <LeafModel Leaf = ConstantLeaf, int Inputs, int Outputs, Executor E>
ReportedForest<Inputs, Outputs, Leaf> train_with_report(const Dataset<Inputs, Outputs>& samples,
                                                        const ExtraTreesOptions& options, const E& executor,
                                                        std::uint64_t seed, std::stop_token stop = {}) {
  detail::GrownTrees grown = detail::grow_forest<Leaf>(samples, options, executor, seed, stop);
  ReportedForest<Inputs, Outputs, Leaf> result;
  result.importance =
      Eigen::Map<const Eigen::VectorXd>(grown.gain.data(), static_cast<Eigen::Index>(grown.gain.size()));
  if (const double sum = result.importance.sum(); sum > 0) result.importance /= sum;
  if (options.bootstrap) {
    result.out_of_bag = detail::out_of_bag_error<Leaf>(grown.trees, samples, executor, seed, stop);
  }
  result.forest = Forest<Inputs, Outputs, Leaf>(std::move(grown.trees));
  return result;
}

}  // namespace surefoot

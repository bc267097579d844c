// Permutation importance (Breiman, "Random forests", Machine Learning 45, 2001): what a forest loses when the values of
// one input are shuffled among the samples.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <utility>

#include "surefoot/core/error.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/fraction_of_variance_unexplained.hpp"
#include "surefoot/forest/leaf.hpp"

namespace surefoot {

/// Per input: by how much the explained share of the variance (R2, the mean over the outputs that vary) falls.
struct PermutationImportance {
  Eigen::VectorXd mean;       // over the repeats; about 0: no influence
  Eigen::VectorXd deviation;  // standard deviation over the repeats
};

/// Best on samples that the forest was not trained on. Two inputs that tell the same share their importance.
/// Cost: inputs * repeats predictions of all samples, and a copy of the samples per thread. Repeat r of input k draws
/// its numbers from stream (k, r) of `seed`, so the result is the same for any executor. Throws a ForestError if the
/// forest is empty or the shapes differ.
template <int Inputs, int Outputs, LeafModel Leaf, Executor E>
PermutationImportance permutation_importance(const Forest<Inputs, Outputs, Leaf>& forest,
                                             const Dataset<Inputs, Outputs>& samples, const E& executor,
                                             std::uint64_t seed, int repeats = 5, std::stop_token stop = {}) {
  detail::check_fit(forest, samples, "permutation_importance");
  if (repeats < 1) throw ForestError("permutation_importance: repeats must be at least 1");
  const Eigen::Index count = samples.inputs.cols();
  if (count > std::numeric_limits<std::int32_t>::max()) {
    throw ForestError("permutation_importance: there can be at most 2^31 - 1 samples");
  }
  const Eigen::Index inputs = samples.inputs.rows();
  const double before = fraction_of_variance_unexplained(forest, samples);
  const auto rises = map(
      executor, static_cast<std::size_t>(inputs * repeats),
      [&](std::size_t job) {
        const auto input = static_cast<Eigen::Index>(job) / repeats;
        const auto repeat = static_cast<Eigen::Index>(job) % repeats;
        Rng rng(seed, static_cast<std::uint64_t>(input), static_cast<std::uint64_t>(repeat));
        Dataset<Inputs, Outputs> shuffled = samples;
        for (Eigen::Index i = count - 1; i > 0; --i) {
          const auto other = static_cast<Eigen::Index>(rng.below(static_cast<std::uint32_t>(i) + 1));
          std::swap(shuffled.inputs(input, i), shuffled.inputs(input, other));
        }
        return fraction_of_variance_unexplained(forest, shuffled) - before;
      },
      stop);
  PermutationImportance importance{Eigen::VectorXd(inputs), Eigen::VectorXd(inputs)};
  for (Eigen::Index k = 0; k < inputs; ++k) {
    const Eigen::Map<const Eigen::ArrayXd> of_input(rises.data() + k * repeats, repeats);
    importance.mean[k] = of_input.mean();
    importance.deviation[k] =
        repeats > 1 ? std::sqrt((of_input - importance.mean[k]).square().sum() / (repeats - 1)) : 0.0;
  }
  return importance;
}

}  // namespace surefoot

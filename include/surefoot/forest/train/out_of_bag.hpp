// The out-of-bag error (Breiman, "Out-of-bag estimation", 1996): with bootstrap, each tree is tested on the samples it
// did not draw (about 37 %), so training tells the error on new samples without a test set.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <tuple>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/trees.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/train/bootstrap.hpp"

namespace surefoot {

/// Errors of the predictions that each sample gets from the trees that did not see it, weighted as the samples are.
/// Somewhat too high for a forest of few trees: a sample is judged by about 37 % of them.
struct OutOfBagError {
  Eigen::VectorXd explained;  // per output: share of its variance (R2), 1 is perfect; 0 if the output does not vary
  Eigen::VectorXd rmse;       // per output: root of the mean squared error [unit of the output]
  Eigen::Index covered = 0;   // samples that at least one tree did not see; if none, the errors are 0
};

namespace detail {

inline std::vector<bool> samples_drawn(std::size_t count, std::uint64_t tree_seed) {
  std::vector<bool> drawn(count, false);
  FastRng rng(tree_seed);
  draw_bootstrap(rng, count, [&](std::size_t sample) { drawn[sample] = true; });
  return drawn;
}

/// Adds what the tree at `root` predicts for x. keys: the sort keys of x shifted up by 32 bits, and a 0 behind them.
template <LeafModel Leaf>
void add_tree(const Trees& trees, std::uint32_t root, const float* x, const std::uint64_t* keys, double* sum) {
  const Node* node = trees.nodes.data() + root;
  while (!node->is_leaf()) node += node->step(keys);
  const auto value = std::bit_cast<float>(node->payload());
  const float* parameters =
      trees.inline_leaves() ? &value : trees.parameters.data() + node->payload() * trees.leaf_parameters;
  Leaf::add(parameters, x, trees.inputs, trees.outputs, sum);
}

/// Weighted sums of outputs and errors, per output.
struct ErrorSums {
  Eigen::ArrayXd output, output_squared, error_squared;  // outputs about those of the first sample
  double weight = 0;
  Eigen::Index covered = 0;
  static constexpr auto fields = std::tuple(&ErrorSums::output, &ErrorSums::output_squared, &ErrorSums::error_squared,
                                            &ErrorSums::weight, &ErrorSums::covered);

  explicit ErrorSums(Eigen::Index outputs = 0)
      : output(Eigen::ArrayXd::Zero(outputs)), output_squared(output), error_squared(output) {}

  void operator+=(const ErrorSums& other) {
    output += other.output;
    output_squared += other.output_squared;
    error_squared += other.error_squared;
    weight += other.weight;
    covered += other.covered;
  }
};

/// Of trees grown with bootstrap on these samples, tree t from tree_seed(seed, t). O(samples * trees * depth).
template <LeafModel Leaf, int Inputs, int Outputs, Executor E>
OutOfBagError out_of_bag_error(const Trees& trees, const Dataset<Inputs, Outputs>& samples, const E& executor,
                               std::uint64_t seed, std::stop_token stop) {
  constexpr Eigen::Index block = 1024;
  const Eigen::Index count = samples.inputs.cols();
  const auto inputs = static_cast<std::size_t>(trees.inputs);
  const Eigen::Index outputs = trees.outputs;
  const auto drawn = map(
      executor, trees.roots.size(),
      [&](std::size_t t) { return samples_drawn(static_cast<std::size_t>(count), tree_seed(seed, t)); }, stop);
  const auto test_block = [&](std::size_t number) {
    ErrorSums sums(outputs);
    std::vector<std::uint64_t> keys(inputs + 1, 0);
    Eigen::ArrayXd prediction(outputs);
    const Eigen::Index begin = static_cast<Eigen::Index>(number) * block;
    for (Eigen::Index i = begin; i < std::min(begin + block, count); ++i) {
      const float* x = samples.inputs.data() + i * trees.inputs;
      for (std::size_t k = 0; k < inputs; ++k) keys[k] = std::uint64_t{sort_key(x[k])} << 32;
      prediction.setZero();
      int voters = 0;
      for (std::size_t t = 0; t < drawn.size(); ++t) {
        if (drawn[t][static_cast<std::size_t>(i)]) continue;
        add_tree<Leaf>(trees, trees.roots[t], x, keys.data(), prediction.data());
        ++voters;
      }
      if (voters == 0) continue;
      const double weight = samples.weights.size() != 0 ? samples.weights[i] : 1.0;
      const Eigen::ArrayXd output = (samples.outputs.col(i) - samples.outputs.col(0)).array();
      sums.output += weight * output;
      sums.output_squared += weight * output.square();
      sums.error_squared += weight * (prediction / voters - samples.outputs.col(i).array()).square();
      sums.weight += weight;
      ++sums.covered;
    }
    return sums;
  };
  const auto blocks = static_cast<std::size_t>((count + block - 1) / block);
  ErrorSums sums(outputs);
  for (const ErrorSums& part : map(executor, blocks, test_block, stop)) sums += part;

  OutOfBagError error{Eigen::VectorXd::Zero(outputs), Eigen::VectorXd::Zero(outputs), sums.covered};
  if (sums.covered == 0) return error;
  for (Eigen::Index o = 0; o < outputs; ++o) {
    const double variation = sums.output_squared[o] - sums.output[o] * sums.output[o] / sums.weight;
    error.rmse[o] = std::sqrt(sums.error_squared[o] / sums.weight);
    if (variation > 0) error.explained[o] = 1 - sums.error_squared[o] / variation;
  }
  return error;
}

}  // namespace detail
}  // namespace surefoot

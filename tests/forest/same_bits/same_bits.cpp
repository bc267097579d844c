// Prints a hash of what a forest file predicts at 10,000 points, one by one and as a batch; with a second argument
// trains the forest and writes the file before.
//
// Compiled several times, see CMakeLists.txt: all must print the same.
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <span>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/serialize.hpp"
#include "tests/forest/samples.hpp"

namespace {

using namespace surefoot;
using Laws = Forest<4, 2, LinearLeaf>;

/// Over [-1, 1)^4 and past it, in multiples of 2^-22, so that no way to compile it rounds differently.
Laws::Batch points(Eigen::Index count) {
  Rng rng(3);
  Laws::Batch inputs(4, count);
  for (float& x : inputs.reshaped()) x = static_cast<float>(rng.below(10U << 20U)) * 0x1p-22F - 1.25F;
  return inputs;
}

unsigned long long hash(const std::filesystem::path& path) {
  const auto forest = load<Laws>(path);
  const Laws::Batch inputs = points(10'000);
  Laws::BatchOutput predicted(2, 2 * inputs.cols());
  Laws::BatchOutput batch;
  forest.predict(inputs, batch);
  predicted.leftCols(inputs.cols()) = batch;
  for (Eigen::Index i = 0; i < inputs.cols(); ++i) {
    predicted.col(inputs.cols() + i) = forest.predict(inputs.col(i).cast<double>());
  }
  return checksum(std::as_bytes(std::span(predicted.data(), static_cast<std::size_t>(predicted.size()))));
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) throw ForestError("usage: same_bits FILE [make]");
  if (argc > 2) {
    const auto samples = toy::sample(toy::ClippedLaws{}, 8000, 1, 0.1);
    const auto forest = train_extra_trees<LinearLeaf>(samples, {.trees = 40, .min_leaf = 10}, Threads(), 1);
    if (forest.raw().nodes.size() < detail::nodes_worth_blocks) throw ForestError("too small to have blocks");
    save(forest, argv[1]);
  }
  std::printf("%016llx\n", hash(argv[1]));
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}

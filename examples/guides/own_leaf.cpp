// A leaf model of your own: the median of a leaf's samples, which a few absurd readings do not move. Exits with 1
// unless its forest is closer to the truth than one of means, and file and C file say the same as the forest.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "surefoot/forest.hpp"

using namespace surefoot;

// [leaf]
struct MedianLeaf {
  static constexpr std::uint32_t tag = 1001;  // its name in files; 0 to 999 are the library's

  // How many floats a leaf keeps.
  static constexpr std::size_t parameters(int /*inputs*/, int outputs) { return static_cast<std::size_t>(outputs); }

  // From at least one sample to these floats.
  static void fit(const LeafSamples& samples, const LeafOptions&, std::span<float> parameters) {
    std::vector<float> values(samples.count());
    for (int o = 0; o < samples.outputs(); ++o) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = samples.output(i)[o];
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::ranges::nth_element(values, middle);
      parameters[static_cast<std::size_t>(o)] = *middle;
    }
  }

  // From these floats and an input to outputs, which are added to `sum`: a forest takes the mean of its trees.
  static void add(const float* parameters, const float* /*x*/, int /*inputs*/, int outputs, double* sum) {
    for (int o = 0; o < outputs; ++o) sum[o] += static_cast<double>(parameters[o]);
  }

  // Optional: the same in C99, for export_c.
  static std::string c_code(int /*inputs*/, int outputs) {
    return "for (o = 0; o < " + std::to_string(outputs) + "; ++o) out[o] += (double)number(p + o);";
  }
};
static_assert(LeafModel<MedianLeaf>);
// [leaf]

namespace {

// One period of a sine, every tenth reading absurd if there are `outliers`.
Dataset<1, 1> readings(int count, bool outliers, Rng rng) {
  Dataset<1, 1> samples{Eigen::Matrix<float, 1, Eigen::Dynamic>(1, count), Eigen::RowVectorXd(count), {}};
  for (Eigen::Index i = 0; i < count; ++i) {
    samples.inputs(0, i) = static_cast<float>(rng.uniform(0, 1));
    samples.outputs(0, i) = std::sin(2 * std::numbers::pi * static_cast<double>(samples.inputs(0, i)));
    if (outliers && rng.uniform() < 0.1) samples.outputs(0, i) += 20 * rng.uniform();
  }
  return samples;
}

}  // namespace

int main() {
  // [train]
  const Dataset<1, 1> seen = readings(5000, true, Rng(1)), truth = readings(2000, false, Rng(2));
  const ExtraTreesOptions options{.trees = 25, .min_leaf = 25};
  const Threads threads;
  const auto medians = train_extra_trees<MedianLeaf>(seen, options, threads, /*seed*/ 1);
  const auto means = train_extra_trees<ConstantLeaf>(seen, options, threads, /*seed*/ 1);
  const double by_medians = fraction_of_variance_unexplained(medians, truth),
               by_means = fraction_of_variance_unexplained(means, truth);  // 1 - R2
  std::printf("not explained: %.3f by medians, %.3f by means\n", by_medians, by_means);
  // [train]

  // [files]
  std::stringstream file;
  save(medians, file);
  const auto loaded = load<Forest<1, 1, MedianLeaf>>(file);
  const bool same = loaded.predict(Vec<1>(0.3)) == medians.predict(Vec<1>(0.3));
  const std::string c_file = export_c(medians, {.function = "sine"});
  // [files]

  // A file of another leaf model is refused.
  bool refused = false;
  try {
    file.clear();
    file.seekg(0);
    load<Forest<1, 1, ConstantLeaf>>(file);
  } catch (const ForestError& error) {
    std::printf("%s\n", error.what());
    refused = true;
  }
  return same && refused && c_file.find("void sine(") != std::string::npos && by_medians < 0.05 &&
                 by_medians < 0.5 * by_means
             ? 0
             : 1;
}

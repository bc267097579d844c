// The work of RFPI, in counts that do not depend on the clock or the threads, and its nominal price.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>

#include "surefoot/forest/options.hpp"
#include "surefoot/solve/rfpi_options.hpp"

namespace surefoot {

struct RfpiWork {
  std::uint64_t steps = 0;    // simulated transitions
  std::uint64_t lookups = 0;  // trees descended
  std::uint64_t fits = 0;     // multiplications of fitting forests, see fit_work()
  static constexpr auto fields = std::tuple(&RfpiWork::steps, &RfpiWork::lookups, &RfpiWork::fits);

  /// Nominal seconds of one core. Prices: CPU time of the two parts, measured apart (docs/rfpi.md).
  double seconds(const Budget& budget) const {
    constexpr double lookup_ns = 25;
    constexpr double fit_ns = 0.5;
    return 1e-9 * (budget.step_ns * static_cast<double>(steps) + lookup_ns * static_cast<double>(lookups) +
                   fit_ns * static_cast<double>(fits));
  }
};

namespace detail {

/// What fitting a forest with linear leaves counts, about, in multiplications. Every sample passes every level of every
/// tree and is in one leaf; affine fits that score splits take all products of some samples of a node for each of the
/// splits, and a factorization of each side.
inline std::uint64_t fit_work(std::size_t samples, int inputs, int outputs, const ExtraTreesOptions& options) {
  constexpr double moved = 8;   // a sample from one level to the next, where there are few inputs or many
  constexpr double sorted = 3;  // a scored sample to the side it is on
  constexpr double vector = 4;  // products of scored samples are taken so many at a time
  const auto count = static_cast<double>(samples);
  const double in = inputs, out = outputs;
  double leaves = std::max(1.0, count / options.min_leaf);
  if (options.max_leaves > 0) leaves = std::min<double>(leaves, options.max_leaves);
  const double levels = std::log2(1 + leaves);
  const double splits = (options.candidates > 0 ? std::min(options.candidates, inputs) : inputs) * options.draws;
  double work = count * (levels * (moved + in) + in * (in + out) + vector * moved);
  if (options.model_score) {
    // A level of so many nodes has `count` samples; of each node about split_samples are scored.
    const double most = options.split_samples > 0 ? options.split_samples : count;
    double scored = 0;
    for (double nodes = 1; nodes < leaves; nodes *= 2) scored += std::min(count, nodes * most);
    const double products = in * (in + 2 * out + 1) / 2;
    const double factorization = in * in * in / 6;
    work += scored * splits * (sorted + products / vector) + leaves * splits * 2 * factorization;
  } else {
    work += count * levels * splits * out;
  }
  return static_cast<std::uint64_t>(options.trees * work);
}

}  // namespace detail

}  // namespace surefoot

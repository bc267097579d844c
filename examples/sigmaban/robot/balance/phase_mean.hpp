// What is usual at each phase of the walk: a running mean that forgets.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "surefoot/core/vec.hpp"

namespace sigmaban {

/// Of N numbers, by bins of the walk cycle; linear between their middles.
template <int N>
class PhaseMean {
 public:
  PhaseMean() { means_.fill(surefoot::Vec<N>::Zero()); }

  /// `phase` in [0,1).
  void add(double phase, const surefoot::Vec<N>& value) {
    const auto bin = std::min(bins - 1, static_cast<std::size_t>(phase * static_cast<double>(bins)));
    counts_[bin] = std::min(counts_[bin] + 1, memory);
    means_[bin] += (value - means_[bin]) / counts_[bin];
  }

  surefoot::Vec<N> at(double phase) const {
    const double place = phase * static_cast<double>(bins) - 0.5, whole = std::floor(place), share = place - whole;
    const auto bin = static_cast<std::size_t>(whole + static_cast<double>(bins)) % bins;
    return (1 - share) * means_[bin] + share * means_[(bin + 1) % bins];
  }

  /// Is there something in each bin?
  bool known() const { return std::ranges::min(counts_) > 0; }

 private:
  static constexpr std::size_t bins = 25;  // of 24 ms at 1.7 Hz: two or three control cycles each
  static constexpr int memory = 40;        // values that count, 15 walk cycles: slopes are learnt, pushes are not
  std::array<surefoot::Vec<N>, bins> means_;
  std::array<int, bins> counts_{};
};

}  // namespace sigmaban

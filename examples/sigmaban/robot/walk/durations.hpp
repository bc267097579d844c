// How long something took, over and over: percentiles without keeping every value.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace sigmaban {

/// Counts by microsecond up to 50 ms; what is longer is known by its maximum alone. Adding allocates nothing. 400 kB.
class Durations {
 public:
  void add(double seconds) {
    const double microseconds = std::max(0.0, std::ceil(seconds * 1e6 - 1e-9));
    ++counts_[static_cast<std::size_t>(std::min(microseconds, static_cast<double>(bins)))];
    longest_ = std::max(longest_, seconds);
    ++count_;
  }

  std::uint64_t count() const { return count_; }
  double longest() const { return longest_; }  // [s]

  /// The shortest duration [s], rounded up to a microsecond, that this share (0 to 1) of them does not exceed.
  double percentile(double share) const {
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
    std::uint64_t so_far = 0;
    for (std::size_t i = 0; i < bins; ++i) {
      so_far += counts_[i];
      if (so_far >= wanted) return static_cast<double>(i) * 1e-6;
    }
    return longest_;
  }

 private:
  static constexpr std::size_t bins = 50'000;
  std::array<std::uint64_t, bins + 1> counts_{};
  std::uint64_t count_ = 0;
  double longest_ = 0;
};

}  // namespace sigmaban

// The k-th smallest and the k-th largest of some numbers, both at once.
//
// A histogram over their range tells in which of its bins the two are; only what lies in those bins is sorted further.
// Cost: two passes over the numbers without a branch that depends on them; where nearly all share one bin (far
// outliers), that of std::nth_element.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "surefoot/forest/train/split.hpp"

namespace surefoot::detail {

class EndRanks {
 public:
  /// The k-th smallest and the k-th largest value of `column`, whose smallest and largest values are `low` and `high`;
  /// k from 1 to the number of records.
  std::pair<float, float> find(const RecordSpan& records, std::size_t column, float low, float high, std::size_t k) {
    const std::size_t count = records.count;
    if (values_.size() < count) {
      values_.resize(count);
      bin_of_.resize(count);
    }
    // Local copies: the compiler cannot know that writing bytes changes none of the members.
    float* values = values_.data();
    std::uint8_t* bin_of = bin_of_.data();
    // Halves, as the whole range may be too wide for single precision; one too narrow is one bin.
    const float unit = static_cast<float>(bins) / (0.5F * high - 0.5F * low);
    const float scale = std::isfinite(unit) ? unit : 0.0F;
    std::array<std::uint32_t, bins> histogram{};
    const float* at = records.first + column;
    for (std::size_t i = 0; i < count; ++i, at += records.stride) {
      const auto place = static_cast<int>((0.5F * *at - 0.5F * low) * scale);
      const auto bin = static_cast<std::uint8_t>(std::min(place, bins - 1));
      values[i] = *at;
      bin_of[i] = bin;
      ++histogram[bin];
    }
    std::size_t low_bin = 0;
    std::size_t below = 0;  // numbers in the bins before
    while (below + histogram[low_bin] < k) below += histogram[low_bin++];
    std::size_t high_bin = bins - 1;
    std::size_t above = 0;
    while (above + histogram[high_bin] < k) above += histogram[high_bin--];

    // What is in the two bins. Each has room for one more: the last write may go behind its last number.
    const std::size_t in_low = histogram[low_bin];
    const std::size_t in_high = histogram[high_bin];
    chosen_.resize(in_low + in_high + 2);
    float* lows = chosen_.data();
    float* highs = lows + in_low + 1;
    for (std::size_t i = 0; i < count; ++i) {
      *lows = values[i];
      *highs = values[i];
      lows += bin_of[i] == low_bin ? 1 : 0;
      highs += bin_of[i] == high_bin ? 1 : 0;
    }
    return {nth(lows - in_low, lows, k - below - 1), nth(highs - in_high, highs, in_high - (k - above))};
  }

 private:
  static constexpr int bins = 256;

  static float nth(float* begin, float* end, std::size_t n) {
    std::nth_element(begin, begin + n, end);
    return begin[n];
  }

  std::vector<float> values_;
  std::vector<std::uint8_t> bin_of_;
  std::vector<float> chosen_;
};

}  // namespace surefoot::detail

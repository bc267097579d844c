// The inner loops of growing a tree: ranges, sums and partitions over records. Records are moved, not indexed, so every
// loop here reads memory in order, and one comparison tests four inputs against their thresholds.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "surefoot/forest/train/records.hpp"

namespace surefoot::detail {

using Quad = float __attribute__((vector_size(16)));
using QuadMask = std::int32_t __attribute__((vector_size(16)));

inline Quad load(const float* memory) {
  Quad quad;
  std::memcpy(&quad, memory, sizeof quad);
  return quad;
}
inline Quad splat(float value) { return Quad{value, value, value, value}; }
inline Quad keep(QuadMask mask, Quad quad) { return reinterpret_cast<Quad>(reinterpret_cast<QuadMask>(quad) & mask); }

/// Smallest, largest and (roughly, in single precision) mean value of every column.
inline void find_range(const RecordSpan& records, float* low, float* high, float* mean) {
  for (std::size_t column = 0; column < records.stride; column += 4) {
    Quad lowest = load(records.first + column);
    Quad highest = lowest;
    Quad sum = splat(0);
    const float* at = records.first + column;
    for (std::size_t i = 0; i < records.count; ++i, at += records.stride) {
      const Quad value = load(at);
      lowest = value < lowest ? value : lowest;
      highest = value > highest ? value : highest;
      sum += value;
    }
    std::memcpy(low + column, &lowest, sizeof lowest);
    std::memcpy(high + column, &highest, sizeof highest);
    sum /= splat(static_cast<float>(records.count));
    for (std::size_t lane = 0; lane < 4; ++lane) {  // where sums or differences overflow, the middle will do
      const bool usable = highest[lane] - lowest[lane] <= std::numeric_limits<float>::max() &&
                          sum[lane] >= lowest[lane] && sum[lane] <= highest[lane];
      mean[column + lane] = usable ? sum[lane] : 0.5F * lowest[lane] + 0.5F * highest[lane];
    }
  }
}

/// What goes left of a threshold, per input.
struct LeftSums {
  std::vector<std::int32_t> count;
  std::vector<double> weight;  // only if weighted
  std::vector<double> output;  // weighted sums of (output - center), [output][input]
  std::vector<double> total;   // the same over all samples, [output]
  double total_weight = 0;

  explicit LeftSums(const RecordShape& shape)
      : count(4 * shape.input_quads()),
        weight(4 * shape.input_quads()),
        output(4 * shape.input_quads() * static_cast<std::size_t>(shape.outputs)),
        total(static_cast<std::size_t>(shape.outputs)) {}
};

constexpr std::size_t sum_block = 512;  // records summed in single precision before the sums go to double

inline void accumulate(Quad sum, double* into) {
  for (std::size_t lane = 0; lane < 4; ++lane) into[lane] += static_cast<double>(sum[lane]);
}

/// Fills `sums` for all inputs at once, each with its own threshold (x <= threshold is left). Outputs are taken
/// relative to `center`.
inline void sum_left(const RecordSpan& records, const RecordShape& shape, const float* thresholds, const float* center,
                     LeftSums& sums) {
  std::fill(sums.count.begin(), sums.count.end(), 0);
  std::fill(sums.weight.begin(), sums.weight.end(), 0.0);
  std::fill(sums.output.begin(), sums.output.end(), 0.0);
  std::fill(sums.total.begin(), sums.total.end(), 0.0);
  sums.total_weight = 0;
  const std::size_t width = 4 * shape.input_quads();
  const std::size_t weight_at = shape.weight_at();
  std::array<float, sum_block> values;
  for (std::size_t begin = 0; begin < records.count; begin += sum_block) {
    const std::size_t count = std::min(sum_block, records.count - begin);
    const float* block = records[begin];
    for (std::size_t column = 0; column < width; column += 4) {
      const Quad threshold = load(thresholds + column);
      QuadMask left{};
      const float* at = block + column;
      for (std::size_t i = 0; i < count; ++i, at += records.stride) left -= load(at) <= threshold;
      for (std::size_t lane = 0; lane < 4; ++lane) sums.count[column + lane] += left[lane];
    }
    // The weights are summed like one more output.
    for (std::size_t o = 0; o < sums.total.size() + (shape.weighted ? 1 : 0); ++o) {
      const bool is_weight = o == sums.total.size();
      double total = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const float* record = block + i * records.stride;
        float value = is_weight ? 1.0F : record[shape.output_at() + o] - center[o];
        if (shape.weighted) value *= record[weight_at];
        values[i] = value;
        total += static_cast<double>(value);
      }
      (is_weight ? sums.total_weight : sums.total[o]) += total;
      double* into = is_weight ? sums.weight.data() : sums.output.data() + o * width;
      for (std::size_t column = 0; column < width; column += 4) {
        const Quad threshold = load(thresholds + column);
        Quad even = splat(0);
        Quad odd = splat(0);
        const float* at = block + column;
        std::size_t i = 0;
        for (; i + 2 <= count; i += 2, at += 2 * records.stride) {
          even += keep(load(at) <= threshold, splat(values[i]));
          odd += keep(load(at + records.stride) <= threshold, splat(values[i + 1]));
        }
        if (i < count) even += keep(load(at) <= threshold, splat(values[i]));
        accumulate(even + odd, into + column);
      }
    }
  }
  if (!shape.weighted) {
    sums.total_weight = static_cast<double>(records.count);
    std::copy(sums.count.begin(), sums.count.end(), sums.weight.begin());
  }
}

/// Moves the records with value <= threshold in `column` to the front of `out` in order, the others to its back in
/// reverse order; returns how many went to the front. `out` has room for all and lies apart.
inline std::size_t partition(const RecordSpan& records, std::size_t column, float threshold, float* out) {
  std::size_t front = 0;
  std::size_t back = (records.count - 1) * records.stride;
  const float* record = records.first;
  for (std::size_t i = 0; i < records.count; ++i, record += records.stride) {
    const bool left = record[column] <= threshold;
    const std::size_t mask = std::size_t{0} - static_cast<std::size_t>(left);
    float* to = out + (back ^ ((back ^ front) & mask));
    for (std::size_t k = 0; k < records.stride; k += 4) std::memcpy(to + k, record + k, sizeof(Quad));
    front += records.stride & mask;
    back -= records.stride & ~mask;
  }
  return front / records.stride;
}

}  // namespace surefoot::detail

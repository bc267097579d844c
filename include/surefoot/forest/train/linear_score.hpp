// Scores of the candidate splits of a node by what affine fits on both sides would explain: least squares by running
// sums and a small Cholesky factorization per side, instead of a fit to the samples per candidate.
//
// Cost per node of n records: O(n inputs (inputs + outputs)) for the products, O(n) and a quarter or so of the products
// per candidate for the sums, and O(inputs^3) per side.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/train/split.hpp"

namespace surefoot::detail {

/// Per record the vector z = (inputs, outputs, 1), inputs and outputs about their mean in the node and inputs in units
/// of their range, and of z z^T the rows of the inputs and of the 1, each from the vector of four that holds its
/// diagonal: that many sums determine the fits.
class LinearScore {
 public:
  explicit LinearScore(const RecordShape& shape)
      : inputs_(static_cast<std::size_t>(shape.inputs)),
        outputs_(static_cast<std::size_t>(shape.outputs)),
        weight_at_(shape.weight_at()),
        weighted_(shape.weighted),
        width_((inputs_ + outputs_ + 1 + 3) / 4 * 4),
        row_begin_(inputs_ + 1) {
    for (std::size_t row = 0; row < inputs_; ++row) {
      row_begin_[row] = products_ - row / 4 * 4;  // where column 0 of the row would be
      products_ += width_ - row / 4 * 4;
    }
    row_begin_[inputs_] = products_;
    products_ = (products_ + width_ + chunk - 1) / chunk * chunk;
    unit_.resize(width_);
    std::fill_n(unit_.begin() + shape.inputs, outputs_, 1.0F);
    shift_.resize(width_);
    shift_[inputs_ + outputs_] = 1;
    z_ = shift_;
    block_.resize(block_size * products_);
    block_total_.resize(products_);
    block_part_.resize(products_);
    total_.resize(products_);
    right_.resize(products_);
    factor_.resize(inputs_ * inputs_);
    solution_.resize(inputs_);
  }

  /// Sums over `records` for splits of the inputs `chosen` at their `thresholds`. low, high, mean: of every column.
  void measure(const RecordSpan& records, std::span<const int> chosen, const float* thresholds, const float* low,
               const float* high, const float* mean) {
    left_.assign(chosen.size() * products_, 0.0);
    left_count_.assign(chosen.size(), 0);
    std::fill(total_.begin(), total_.end(), 0.0);
    count_ = records.count;
    for (std::size_t k = 0; k < inputs_; ++k) {
      const float unit = 1 / (high[k] - low[k]);
      unit_[k] = std::isfinite(unit) ? unit : 0.0F;  // not if the input is constant, or nearly
    }
    std::array<std::uint32_t, block_size> on_left;
    std::array<std::uint32_t, block_size> on_right;
    for (std::size_t begin = 0; begin < records.count; begin += block_size) {
      const std::size_t count = std::min(block_size, records.count - begin);
      multiply({records[begin], count, records.stride}, mean);
      for (std::size_t p = 0; p < products_; ++p) total_[p] += static_cast<double>(block_total_[p]);
      for (std::size_t c = 0; c < chosen.size(); ++c) {
        const auto input = static_cast<std::size_t>(chosen[c]);
        std::size_t lefts = 0;
        std::size_t rights = 0;
        const float threshold = thresholds[input];
        const float* value = records[begin] + input;
        for (std::size_t i = 0; i < count; ++i, value += records.stride) {
          const bool left = *value <= threshold;
          on_left[lefts] = static_cast<std::uint32_t>(i);
          on_right[rights] = static_cast<std::uint32_t>(i);
          lefts += left ? 1U : 0U;
          rights += left ? 0U : 1U;
        }
        left_count_[c] += lefts;
        double* into = left_.data() + c * products_;
        if (lefts <= rights) {  // sum the smaller side
          sum_products(std::span(on_left).first(lefts));
          for (std::size_t p = 0; p < products_; ++p) into[p] += static_cast<double>(block_part_[p]);
        } else {
          sum_products(std::span(on_right).first(rights));
          for (std::size_t p = 0; p < products_; ++p) {
            into[p] += static_cast<double>(block_total_[p]) - static_cast<double>(block_part_[p]);
          }
        }
      }
    }
  }

  std::size_t left_count(std::size_t candidate) const { return left_count_[candidate]; }

  /// What one fit to the whole node explains of the outputs' squares (about the means given to `measure`).
  double explained_together(std::span<const double> output_scale, double ridge) {
    return explained(total_.data(), count_, output_scale, ridge);
  }

  /// What two fits explain, left and right of the candidate's threshold.
  double explained_apart(std::size_t candidate, std::span<const double> output_scale, double ridge) {
    const double* left = left_.data() + candidate * products_;
    for (std::size_t p = 0; p < products_; ++p) right_[p] = total_[p] - left[p];
    return explained(left, left_count_[candidate], output_scale, ridge) +
           explained(right_.data(), count_ - left_count_[candidate], output_scale, ridge);
  }

 private:
  static constexpr std::size_t block_size = 64;  // records whose products stay in the L1 cache
  static constexpr std::size_t chunk = 16;       // sums kept in registers at a time

  void multiply(const RecordSpan& records, const float* mean) {
    // Local copies: the compiler cannot know that writing products changes none of the members.
    float* product = block_.data();
    float* z = z_.data();
    const float* unit = unit_.data();
    const float* shift = shift_.data();
    const std::size_t* row_begin = row_begin_.data();
    const std::size_t inputs = inputs_;
    const std::size_t width = width_;
    const std::size_t products = products_;
    const std::size_t used = std::min(width, records.stride);
    for (std::size_t i = 0; i < records.count; ++i, product += products) {
      const float* record = records[i];
      for (std::size_t k = 0; k < used; k += 4) {
        const Quad values = (load(record + k) - load(mean + k)) * load(unit + k) + load(shift + k);
        std::memcpy(z + k, &values, sizeof values);
      }
      const float weight = weighted_ ? record[weight_at_] : 1.0F;
      for (std::size_t row = 0; row <= inputs; ++row) {
        const Quad factor = splat(weight * (row < inputs ? z[row] : 1.0F));
        float* into = product + row_begin[row];
        for (std::size_t column = row < inputs ? row / 4 * 4 : 0; column < width; column += 4) {
          const Quad values = factor * load(z + column);
          std::memcpy(into + column, &values, sizeof values);
        }
      }
    }
    std::array<std::uint32_t, block_size> all;
    for (std::size_t i = 0; i < records.count; ++i) all[i] = static_cast<std::uint32_t>(i);
    sum_products(std::span(all).first(records.count));
    block_total_.swap(block_part_);
  }

  void sum_products(std::span<const std::uint32_t> records) {
    const float* block = block_.data();
    const std::size_t products = products_;
    for (std::size_t p = 0; p < products; p += chunk) {
      Quad a = splat(0);
      Quad b = a;
      Quad c = a;
      Quad d = a;
      for (const std::uint32_t i : records) {
        const float* product = block + i * products + p;
        a += load(product);
        b += load(product + 4);
        c += load(product + 8);
        d += load(product + 12);
      }
      std::memcpy(&block_part_[p], &a, sizeof a);
      std::memcpy(&block_part_[p + 4], &b, sizeof b);
      std::memcpy(&block_part_[p + 8], &c, sizeof c);
      std::memcpy(&block_part_[p + 12], &d, sizeof d);
    }
  }

  // Scaled sum over the outputs of W mean^2 + b^T A^-1 b, with A and b the second moments about the side's own mean and
  // the diagonal of A enlarged as LinearLeaf does.
  double explained(const double* sums, std::size_t count, std::span<const double> output_scale, double ridge) {
    const double* ones = sums + row_begin_[inputs_];
    const double weight = ones[inputs_ + outputs_];
    const double enlarge = 1 + std::max(ridge, LinearLeaf::least_ridge) / static_cast<double>(count);
    for (std::size_t i = 0; i < inputs_; ++i) {
      double* row = &factor_[i * inputs_];
      for (std::size_t j = 0; j <= i; ++j) {
        double value = sums[row_begin_[j] + i] - ones[i] * ones[j] / weight;
        if (i == j) value *= enlarge;
        const double pivot = value;
        const double* other = &factor_[j * inputs_];
        for (std::size_t k = 0; k < j; ++k) value -= row[k] * other[k];
        if (i != j) {
          row[j] = value * other[j];
        } else {
          // The inverse pivot; 0 leaves an input out that single precision cannot tell from constant or from the
          // others.
          row[i] = value > 1e-7 * pivot && pivot > 1e-6 * weight ? 1 / std::sqrt(value) : 0.0;
        }
      }
    }
    double sum = 0;
    for (std::size_t o = 0; o < outputs_; ++o) {
      const std::size_t column = inputs_ + o;
      double squares = ones[column] * ones[column] / weight;
      for (std::size_t i = 0; i < inputs_; ++i) {
        const double* row = &factor_[i * inputs_];
        double value = sums[row_begin_[i] + column] - ones[i] * ones[column] / weight;
        for (std::size_t k = 0; k < i; ++k) value -= row[k] * solution_[k];
        solution_[i] = value * row[i];
        squares += solution_[i] * solution_[i];
      }
      sum += output_scale[o] * squares;
    }
    return sum;
  }

  std::size_t inputs_;
  std::size_t outputs_;
  std::size_t weight_at_;
  bool weighted_;
  std::size_t width_;                   // of z, in whole vectors
  std::vector<std::size_t> row_begin_;  // of the rows of z z^T, per record
  std::size_t products_ = 0;            // per record, in whole chunks
  std::size_t count_ = 0;
  std::vector<float> unit_, shift_;  // z = (record - mean) * unit + shift
  std::vector<float> z_, block_, block_total_, block_part_;
  std::vector<double> total_, left_, right_, factor_, solution_;
  std::vector<std::size_t> left_count_;
};

}  // namespace surefoot::detail

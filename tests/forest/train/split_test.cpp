#include "surefoot/forest/train/split.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "surefoot/core/rng.hpp"

namespace surefoot {
namespace {

using detail::RecordShape;
using detail::RecordSpan;

std::vector<float> random_records(const RecordShape& shape, std::size_t count) {
  Rng rng(1);
  std::vector<float> numbers(count * shape.stride(), 0.0F);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < shape.weight_at() + (shape.weighted ? 1 : 0); ++k) {
      numbers[i * shape.stride() + k] = static_cast<float>(rng.uniform(0.5, 2));
    }
  }
  return numbers;
}

TEST_CASE("sums left of a threshold are those of the samples there") {
  for (const RecordShape shape : {RecordShape{1, 1, false}, RecordShape{6, 1, false}, RecordShape{5, 3, true},
                                  RecordShape{9, 2, true}, RecordShape{4, 4, false}}) {
    for (const std::size_t count : {1U, 7U, 511U, 512U, 1300U}) {
      const auto numbers = random_records(shape, count);
      const RecordSpan records{numbers.data(), count, shape.stride()};
      std::vector<float> thresholds(4 * shape.input_quads());
      for (std::size_t k = 0; k < thresholds.size(); ++k) thresholds[k] = 0.6F + 0.1F * static_cast<float>(k);
      const std::vector<float> center(static_cast<std::size_t>(shape.outputs), 1.25F);
      detail::LeftSums sums(shape);
      detail::sum_left(records, shape, thresholds.data(), center.data(), sums);
      for (std::size_t k = 0; k < static_cast<std::size_t>(shape.inputs); ++k) {
        int left = 0;
        double weight = 0;
        std::vector<double> output(center.size(), 0.0);
        for (std::size_t i = 0; i < count; ++i) {
          if (records[i][k] > thresholds[k]) continue;
          const double w = shape.weighted ? static_cast<double>(records[i][shape.weight_at()]) : 1.0;
          ++left;
          weight += w;
          for (std::size_t o = 0; o < output.size(); ++o) {
            output[o] += w * (static_cast<double>(records[i][shape.output_at() + o]) - 1.25);
          }
        }
        CHECK(sums.count[k] == left);
        CHECK(sums.weight[k] == doctest::Approx(weight).epsilon(1e-5));
        for (std::size_t o = 0; o < output.size(); ++o) {
          CHECK(sums.output[o * 4 * shape.input_quads() + k] == doctest::Approx(output[o]).epsilon(1e-4));
        }
      }
    }
  }
}

TEST_CASE("a partition keeps every record whole and on its side") {
  const RecordShape shape{6, 3, false};
  for (const std::size_t count : {1U, 2U, 100U}) {
    const auto numbers = random_records(shape, count);
    const RecordSpan records{numbers.data(), count, shape.stride()};
    for (const float threshold : {0.0F, 1.2F, 9.0F}) {
      std::vector<float> out(numbers.size(), -1.0F);
      const std::size_t left = detail::partition(records, 2, threshold, out.data());
      std::multiset<std::vector<float>> before;
      std::multiset<std::vector<float>> after;
      for (std::size_t i = 0; i < count; ++i) {
        const float* record = out.data() + i * shape.stride();
        CHECK((record[2] <= threshold) == (i < left));
        before.insert({records[i], records[i] + shape.stride()});
        after.insert({record, record + shape.stride()});
      }
      CHECK(before == after);
    }
  }
}

TEST_CASE("ranges cover every column") {
  const RecordShape shape{3, 2, true};
  const auto numbers = random_records(shape, 40);
  const RecordSpan records{numbers.data(), 40, shape.stride()};
  std::vector<float> low(shape.stride());
  std::vector<float> high(shape.stride());
  std::vector<float> mean(shape.stride());
  detail::find_range(records, low.data(), high.data(), mean.data());
  for (std::size_t k = 0; k < 6; ++k) {
    std::vector<float> column;
    double sum = 0;
    for (std::size_t i = 0; i < 40; ++i) {
      column.push_back(records[i][k]);
      sum += static_cast<double>(records[i][k]);
    }
    CHECK(low[k] == *std::min_element(column.begin(), column.end()));
    CHECK(high[k] == *std::max_element(column.begin(), column.end()));
    CHECK(static_cast<double>(mean[k]) == doctest::Approx(sum / 40));
  }
}

}  // namespace
}  // namespace surefoot

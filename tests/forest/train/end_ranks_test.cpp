#include "surefoot/forest/train/end_ranks.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/core/rng.hpp"

namespace surefoot {
namespace {

// How many of the ranks are not those of the sorted numbers; the numbers are column 1 of records of 4.
int wrong_ranks(const std::vector<float>& numbers) {
  std::vector<float> records(4 * numbers.size(), -7.0F);
  for (std::size_t i = 0; i < numbers.size(); ++i) records[4 * i + 1] = numbers[i];
  std::vector<float> sorted = numbers;
  std::sort(sorted.begin(), sorted.end());
  detail::EndRanks ranks;
  int wrong = 0;
  for (std::size_t k = 1; k <= numbers.size(); k += 1 + k / 8) {
    const auto [low, high] = ranks.find({records.data(), numbers.size(), 4}, 1, sorted.front(), sorted.back(), k);
    if (low != sorted[k - 1] || high != sorted[sorted.size() - k]) ++wrong;
  }
  return wrong;
}

std::vector<float> draw(std::size_t count, auto&& number) {
  Rng rng(count);
  std::vector<float> numbers(count);
  for (float& value : numbers) value = static_cast<float>(number(rng));
  return numbers;
}

TEST_CASE("ranks from both ends are those of the sorted numbers") {
  constexpr double huge = std::numeric_limits<float>::max();
  for (const std::size_t count : {1U, 2U, 3U, 40U, 255U, 1000U, 20'000U}) {
    CAPTURE(count);
    CHECK(wrong_ranks(draw(count, [](Rng& rng) { return rng.uniform(-3, 5); })) == 0);
    CHECK(wrong_ranks(draw(count, [](Rng& rng) { return std::exp(10 * rng.normal()); })) == 0);  // most share a bin
    CHECK(wrong_ranks(draw(count, [](Rng& rng) { return static_cast<double>(rng.below(5)); })) == 0);
    CHECK(wrong_ranks(draw(count, [](Rng& rng) { return 1e6 + rng.uniform(); })) == 0);
    CHECK(wrong_ranks(draw(count, [](Rng& rng) { return huge * rng.uniform(-1, 1); })) == 0);
    CHECK(wrong_ranks(draw(count, [](Rng& rng) { return rng.below(2) == 0 ? -huge : huge; })) == 0);
    CHECK(wrong_ranks(draw(count, [](Rng& rng) { return 1e-45 * rng.below(9); })) == 0);  // no bin is that narrow
    CHECK(wrong_ranks(draw(count, [](Rng&) { return 2; })) == 0);
  }
}

}  // namespace
}  // namespace surefoot

#include "surefoot/core/rng.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace surefoot {
namespace {

using Block = std::array<std::uint32_t, 4>;

double mean_of(const std::vector<double>& samples) {
  double sum = 0;
  for (const double sample : samples) sum += sample;
  return sum / static_cast<double>(samples.size());
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = mean_of(a);
  const double mean_b = mean_of(b);
  double ab = 0;
  double aa = 0;
  double bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return ab / std::sqrt(aa * bb);
}

// Whether numbers in [0,1) fill `slices` equal slices evenly: the chi-square statistic within 5 standard deviations.
bool evenly_spread(const std::vector<double>& samples, std::size_t slices) {
  std::vector<double> counts(slices);
  for (const double sample : samples) ++counts.at(static_cast<std::size_t>(sample * static_cast<double>(slices)));
  const double expected = static_cast<double>(samples.size()) / static_cast<double>(slices);
  double chi_square = 0;
  for (const double count : counts) chi_square += (count - expected) * (count - expected) / expected;
  const double freedom = static_cast<double>(slices - 1);
  return std::abs(chi_square - freedom) <= 5 * std::sqrt(2 * freedom);
}

constexpr std::size_t many = 20'000;
const double five_sigma = 5 / std::sqrt(static_cast<double>(many));  // of a correlation of `many` independent pairs

TEST_CASE("Philox4x32-10 gives the known answers of its authors") {
  CHECK(philox4x32({0, 0, 0, 0}, {0, 0}) == Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  constexpr std::uint32_t ones = 0xffffffff;
  CHECK(philox4x32({ones, ones, ones, ones}, {ones, ones}) == Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("uniform numbers lie in [0,1) and are spread evenly, with the right moments") {
  Rng rng(7);
  std::vector<double> samples(many);
  double squares = 0;
  for (double& sample : samples) {
    sample = rng.uniform();
    squares += sample * sample;
  }
  CHECK(*std::min_element(samples.begin(), samples.end()) >= 0.0);
  CHECK(*std::max_element(samples.begin(), samples.end()) < 1.0);
  CHECK(evenly_spread(samples, 100));
  CHECK(std::abs(mean_of(samples) - 1.0 / 2) < five_sigma * std::sqrt(1.0 / 12));
  CHECK(std::abs(squares / many - 1.0 / 3) < five_sigma * std::sqrt(4.0 / 45));
}

TEST_CASE("uniform(low, high) stays in its interval") {
  Rng rng(7);
  for (int i = 0; i < 1000; ++i) {
    const double x = rng.uniform(-3, -2);
    CHECK(x >= -3);
    CHECK(x < -2);
  }
  CHECK(rng.uniform(4, 4) == 4);
}

TEST_CASE("normal numbers have the moments of the standard normal distribution") {
  Rng rng(7);
  std::array<double, 4> moments{};
  for (std::size_t i = 0; i < many; ++i) {
    const double x = rng.normal();
    for (std::size_t k = 0; k < 4; ++k) moments[k] += std::pow(x, static_cast<double>(k + 1)) / many;
  }
  CHECK(std::abs(moments[0]) < five_sigma);
  CHECK(std::abs(moments[1] - 1) < five_sigma * std::sqrt(2.0));
  CHECK(std::abs(moments[2]) < five_sigma * std::sqrt(15.0));
  CHECK(std::abs(moments[3] - 3) < five_sigma * std::sqrt(96.0));
}

TEST_CASE("the normal quantile agrees with tables and with the error function, far into both tails") {
  CHECK(normal_quantile(0.5) == 0.0);
  CHECK(normal_quantile(0.975) == doctest::Approx(1.959963984540054).epsilon(1e-14));
  CHECK(normal_quantile(0.9999) == doctest::Approx(3.719016485455709).epsilon(1e-12));
  CHECK(normal_quantile(1e-10) == doctest::Approx(-6.361340902404056).epsilon(1e-14));
  for (double p = 1e-300; p < 0.5; p *= 1.7) {
    CAPTURE(p);
    const double back = 0.5 * std::erfc(-normal_quantile(p) / std::sqrt(2.0));
    CHECK(back == doctest::Approx(p).epsilon(1e-12));
  }
  for (const double p : {0.6, 0.9, 0.93}) CHECK(normal_quantile(p) == doctest::Approx(-normal_quantile(1 - p)));
}

TEST_CASE("below(count) is uniform over its integers, without the bias of a plain remainder") {
  Rng rng(7);
  for (const std::uint32_t count : {1U, 3U, 10U, 0xC0000000U}) {
    CAPTURE(count);
    std::vector<double> samples(many);
    bool in_range = true;
    for (double& sample : samples) {
      const std::uint32_t value = rng.below(count);
      in_range = in_range && value < count;
      sample = (value + 0.5) / count;
    }
    CHECK(in_range);
    CHECK(evenly_spread(samples, std::min(count, 60U)));
  }
  CHECK_THROWS_AS(rng.below(0), CoreError);
}

TEST_CASE("a stream is determined by its seed and keys, not by what was drawn before") {
  Rng a(1, 2, 3);
  Rng b(1, 2, 3);
  CHECK(a.bits() == b.bits());
  for (int i = 0; i < 5; ++i) a.uniform();
  CHECK(a.stream(4).bits() == b.stream(4).bits());
  CHECK(Rng(1).stream(2, 3).bits() == Rng(1, 2, 3).bits());
  static_assert(Rng(1).bits() == Rng(1).bits());
}

TEST_CASE("a copy continues from the same place") {
  Rng a(1);
  a.bits();
  Rng b = a;
  for (int i = 0; i < 10; ++i) CHECK(a.bits() == b.bits());
}

TEST_CASE("the numbers of a seed never change between platforms and versions") {
  CHECK(Rng(1).bits() == 0x3168b58af5c7e962ULL);
  CHECK(Rng(1, 2).stream(3).bits() == 0x305649448400d1faULL);
  CHECK(Rng(42).uniform() == 0x1.8a254ce4c1a1p-4);
}

TEST_CASE("nearby seeds, nearby keys, parents and consecutive draws are uncorrelated") {
  std::vector<double> base(many);
  std::vector<double> next_seed(many);
  std::vector<double> child(many);
  std::vector<double> grandchild(many);
  std::vector<double> next_draw(many);
  for (std::size_t i = 0; i < many; ++i) {
    Rng rng(i, 5);
    child[i] = rng.stream(0).uniform();
    grandchild[i] = rng.stream(0, 0).uniform();
    base[i] = rng.uniform();
    next_draw[i] = rng.uniform();
    next_seed[i] = Rng(i + 1, 5).uniform();
  }
  for (const auto& other : {next_seed, child, grandchild, next_draw}) {
    CHECK(evenly_spread(other, 50));
    CHECK(std::abs(correlation(base, other)) < five_sigma);
  }
  CHECK(Rng(1, 2).bits() != Rng(2, 1).bits());
  CHECK(Rng(1).bits() != Rng(1, 0).bits());
}

TEST_CASE("an Rng drives the standard library's shuffles and distributions") {
  Rng rng(3);
  std::vector<int> items(20);
  for (int i = 0; i < 20; ++i) items[static_cast<std::size_t>(i)] = i;
  std::vector<int> shuffled = items;
  std::shuffle(shuffled.begin(), shuffled.end(), rng);
  CHECK(shuffled != items);
  CHECK(std::is_permutation(shuffled.begin(), shuffled.end(), items.begin()));
}

TEST_CASE("chosen draws come first, then the stream's own; streams of it are not chosen") {
  const std::array<double, 2> chosen{0.25, 0.975};
  Rng rng = Rng(9).with_draws(chosen);
  CHECK(rng.uniform() == 0.25);
  CHECK(rng.normal() == doctest::Approx(1.959963984540054));
  CHECK(rng.uniform() == Rng(9).uniform());
  CHECK(Rng(9).with_draws(chosen).stream(1).uniform() == Rng(9, 1).uniform());
  Rng bits = Rng(9).with_draws(chosen);
  CHECK(bits.bits() == Rng(9).bits());
}

TEST_CASE("a Latin hypercube puts one point into each slice of every dimension") {
  for (const std::uint32_t count : {1U, 2U, 9U, 64U}) {
    Rng rng(count);
    const std::vector<double> points = latin_hypercube(count, 3, rng);
    REQUIRE(points.size() == std::size_t{count} * 3);
    for (std::size_t d = 0; d < 3; ++d) {
      std::vector<int> hits(count);
      for (std::size_t i = 0; i < count; ++i) ++hits.at(static_cast<std::size_t>(points[3 * i + d] * count));
      CHECK(std::all_of(hits.begin(), hits.end(), [](int n) { return n == 1; }));
    }
  }
}

TEST_CASE("each point of a Latin hypercube is uniform and its dimensions are uncorrelated") {
  std::vector<double> x(many);
  std::vector<double> y(many);
  Rng rng(1);
  for (std::size_t i = 0; i < many; ++i) {
    const std::vector<double> points = latin_hypercube(5, 2, rng);
    const std::size_t point = i % 5;
    x[i] = points[2 * point];
    y[i] = points[2 * point + 1];
  }
  CHECK(evenly_spread(x, 50));
  CHECK(evenly_spread(y, 50));
  CHECK(std::abs(correlation(x, y)) < five_sigma);
}

TEST_CASE("averages over a Latin hypercube have a tenth of the variance of independent draws, or less") {
  constexpr std::uint32_t count = 9;
  const auto smooth = [](double x, double y) { return std::exp(x) + std::sin(3 * y); };
  const auto variance = [&](auto&& average) {
    std::vector<double> averages(2000);
    for (std::size_t i = 0; i < averages.size(); ++i) averages[i] = average(i);
    const double mean = mean_of(averages);
    double squares = 0;
    for (const double a : averages) squares += (a - mean) * (a - mean);
    return squares;
  };
  const double independent = variance([&](std::size_t i) {
    Rng rng(1, i);
    double sum = 0;
    for (std::uint32_t n = 0; n < count; ++n) {
      const double x = rng.uniform();
      sum += smooth(x, rng.uniform());
    }
    return sum / count;
  });
  const double stratified = variance([&](std::size_t i) {
    Rng rng(2, i);
    const std::vector<double> points = latin_hypercube(count, 2, rng);
    double sum = 0;
    for (std::size_t n = 0; n < count; ++n) {
      Rng noise = rng.with_draws(std::span(points).subspan(2 * n, 2));
      const double x = noise.uniform();
      sum += smooth(x, noise.uniform());
    }
    return sum / count;
  });
  CHECK(stratified < independent / 10);
}

}  // namespace
}  // namespace surefoot

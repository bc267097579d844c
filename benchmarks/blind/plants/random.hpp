// Random draws for the plants, from the standard library alone.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace plants {

struct Random {
  std::mt19937_64 engine;

  explicit Random(std::uint64_t seed) : engine(seed) {}

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  double normal(double deviation) { return std::normal_distribution<double>(0.0, deviation)(engine); }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  std::size_t index(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine); }

  template <class T>
  const T& choice(const std::vector<T>& values) {
    return values[index(values.size())];
  }
};

}  // namespace plants

// Random numbers of training, and the samples that a tree draws with replacement.
#pragma once

#include <cstddef>
#include <cstdint>

#include "surefoot/core/rng.hpp"

namespace surefoot::detail {

/// The seed of one tree's random numbers.
inline std::uint64_t tree_seed(std::uint64_t seed, std::size_t tree) { return Rng(seed, tree).bits(); }

/// Random numbers for the training loop: SplitMix64 (Steele, Lea & Flood 2014), the same on every platform.
class FastRng {
 public:
  explicit FastRng(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(((bits() >> 32) * count) >> 32);  // bias below 2^-32 per value: no matter here
  }

 private:
  std::uint64_t state_;
};

/// The samples that a tree learns from if it draws them with replacement: `use(i)` for each of `count` draws.
template <class Use>
void draw_bootstrap(FastRng& rng, std::size_t count, const Use& use) {
  for (std::size_t i = 0; i < count; ++i) use(std::size_t{rng.below(static_cast<std::uint32_t>(count))});
}

}  // namespace surefoot::detail

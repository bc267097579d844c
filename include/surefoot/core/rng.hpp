// Counter-based random numbers: a stream is named by a seed and keys, so any piece of work can draw its own numbers
// and the result does not depend on which thread does it, or when.
//
// Generator: Philox4x32-10 (Salmon, Moraes, Dror, Shaw: "Parallel random numbers: as easy as 1, 2, 3", SC 2011).
// bits() and uniform() are the same on every platform; normal() uses the C library's log and sqrt in its tails.
// Cost: about ten 32x32-bit products per double, no memory traffic; a stream is some 60 bytes.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"

namespace surefoot {

/// One block of Philox4x32-10: 128 bits of counter and 64 bits of key in, 128 random bits out.
constexpr std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53U} * counter[0];
    const std::uint64_t b = std::uint64_t{0xCD9E8D57U} * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key[0] += 0x9E3779B9U;
    key[1] += 0xBB67AE85U;
  }
  return counter;
}

namespace detail {

/// first x^n + ... + last, by Horner's rule.
template <class... Coefficient>
constexpr double polynomial(double x, double first, Coefficient... rest) {
  ((first = first * x + rest), ...);
  return first;
}

/// The rational function of AS 241 around the median, q = p - 0.5.
inline double normal_quantile_centre(double q) {
  const double r = 0.180625 - q * q;
  return q *
         polynomial(r, 2509.0809287301226727, 33430.575583588128105, 67265.770927008700853, 45921.953931549871457,
                    13731.693765509461125, 1971.5909503065514427, 133.14166789178437745, 3.387132872796366608) /
         polynomial(r, 5226.495278852545925, 28729.085735721942674, 39307.89580009271061, 21213.794301586595867,
                    5394.1960214247511077, 687.1870074920579083, 42.313330701600911252, 1.0);
}

/// The same in the tails, `tail` = sqrt(-log of the smaller of p and 1 - p).
inline double normal_quantile_tail(double tail) {
  if (tail <= 5) {
    const double r = tail - 1.6;
    return polynomial(r, 7.7454501427834140764e-4, 0.0227238449892691845833, 0.24178072517745061177,
                      1.27045825245236838258, 3.64784832476320460504, 5.7694972214606914055, 4.6303378461565452959,
                      1.42343711074968357734) /
           polynomial(r, 1.05075007164441684324e-9, 5.475938084995344946e-4, 0.0151986665636164571966,
                      0.14810397642748007459, 0.68976733498510000455, 1.6763848301838038494, 2.05319162663775882187,
                      1.0);
  }
  const double r = tail - 5;
  return polynomial(r, 2.01033439929228813265e-7, 2.71155556874348757815e-5, 0.0012426609473880784386,
                    0.026532189526576123093, 0.29656057182850489123, 1.7848265399172913358, 5.4637849111641143699,
                    6.6579046435011037772) /
         polynomial(r, 2.04426310338993978564e-15, 1.4215117583164458887e-7, 1.8463183175100546818e-5,
                    7.868691311456132591e-4, 0.0148753612908506148525, 0.13692988092273580531, 0.59983220655588793769,
                    1.0);
}

}  // namespace detail

/// Quantile of the standard normal distribution, for 0 < p < 1; relative accuracy about 1e-16.
/// Algorithm AS 241 (Wichura, Applied Statistics 37, 1988).
inline double normal_quantile(double p) {
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    return detail::normal_quantile_centre(q);
  }
  const double magnitude = detail::normal_quantile_tail(std::sqrt(-std::log(q < 0 ? p : 1.0 - p)));
  return q < 0 ? -magnitude : magnitude;
}

/// A stream of random numbers. Two streams with different seeds or keys are independent; the same seed and keys give
/// the same numbers everywhere. Copies continue independently from the same place (common random numbers).
///
///   Rng rng(seed, episode);          // stream number `episode` of `seed`
///   Rng noise = rng.stream(step);    // a stream of that stream
class Rng {
 public:
  template <std::convertible_to<std::uint64_t>... Keys>
  explicit constexpr Rng(std::uint64_t seed, Keys... keys) {
    absorb(seed);
    (absorb(static_cast<std::uint64_t>(keys)), ...);
  }

  /// The stream named by this stream's own name and `keys`; how much was drawn from this one does not matter.
  template <std::convertible_to<std::uint64_t>... Keys>
  constexpr Rng stream(Keys... keys) const {
    Rng child = *this;
    child.draws_ = 0;
    child.chosen_ = {};
    (child.absorb(static_cast<std::uint64_t>(keys)), ...);
    return child;
  }

  /// This stream with its first uniform() draws replaced by `draws`, each in [0,1); later draws are its own. Lets a
  /// caller choose the noise of a black-box simulator, e.g. from latin_hypercube(). `draws` must outlive the copy.
  constexpr Rng with_draws(std::span<const double> draws) const {
    Rng copy = *this;
    copy.chosen_ = draws;
    return copy;
  }

  /// 64 random bits.
  constexpr std::uint64_t bits() {
    if (draws_ % 2 == 0) {
      block_ = philox4x32({low(draws_ / 2), high(draws_ / 2), low(name_), high(name_)}, key_);
    }
    const std::size_t half = 2 * (draws_++ % 2);
    return (std::uint64_t{block_[half]} << 32) | block_[half + 1];
  }

  /// Uniform in [0, 1), 53 bits.
  constexpr double uniform() {
    if (chosen_.empty()) return static_cast<double>(bits() >> 11) * 0x1p-53;
    const double draw = chosen_.front();
    chosen_ = chosen_.subspan(1);
    return draw;
  }

  /// Uniform in [low, high).
  constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Standard normal, by inversion (one uniform each, so that chosen draws carry over).
  double normal() {
    const double p = uniform();
    return normal_quantile(p > 0x1p-54 ? p : 0x1p-54);
  }

  /// Uniform integer in [0, count); count > 0. Unbiased (Lemire, "Fast random integer generation in an interval",
  /// 2019).
  constexpr std::uint32_t below(std::uint32_t count) {
    if (count == 0) throw CoreError("Rng::below: count must be positive");
    std::uint64_t product = (bits() >> 32) * count;
    if (static_cast<std::uint32_t>(product) < count) {
      const std::uint32_t reject = (0U - count) % count;
      while (static_cast<std::uint32_t>(product) < reject) product = (bits() >> 32) * count;
    }
    return static_cast<std::uint32_t>(product >> 32);
  }

  // UniformRandomBitGenerator, for <random> and std::shuffle.
  using result_type = std::uint64_t;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }
  constexpr result_type operator()() { return bits(); }

 private:
  static constexpr std::uint32_t low(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
  static constexpr std::uint32_t high(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }

  // A stream's name is 128 bits: the key, and the upper half of the counter. Absorbing a key hashes all of it anew.
  constexpr void absorb(std::uint64_t key) {
    const auto mixed = philox4x32({low(key), high(key), low(name_), high(name_)}, key_);
    key_ = {mixed[0], mixed[1]};
    name_ = (std::uint64_t{mixed[2]} << 32) | mixed[3];
  }

  std::array<std::uint32_t, 2> key_{0x73757265U, 0x666F6F74U};  // "sure", "foot"
  std::uint64_t name_ = 0;
  std::uint64_t draws_ = 0;
  std::array<std::uint32_t, 4> block_{};
  std::span<const double> chosen_;
};

/// `count` points of `dims` numbers in [0,1), point after point: along every dimension each of `count` equal slices
/// holds one point (Latin hypercube; McKay, Beckman, Conover 1979). Averages of smooth functions over them have far
/// less variance than over independent draws.
std::vector<double> latin_hypercube(std::uint32_t count, std::uint32_t dims, Rng& rng);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/core/rng.ipp"
#endif

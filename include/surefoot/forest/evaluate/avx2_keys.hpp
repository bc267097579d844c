// The keys of an input in AVX2 registers, for the two ways down that use them.
#pragma once

#include "surefoot/forest/evaluate/avx2.hpp"

#ifdef SUREFOOT_AVX2

// GCC's <immintrin.h> costs 0.3 s and 100 MB, nearly all of it for AVX-512; these two parts of it cost a tenth. They
// may only be included by it, so its guard is set meanwhile.
#if defined(__clang__) || __GNUC__ > 15 || defined(_IMMINTRIN_H_INCLUDED)
#include <immintrin.h>
#else
#include <smmintrin.h>
#define _IMMINTRIN_H_INCLUDED
#include <avxintrin.h>
// the second needs the first
#include <avx2intrin.h>
#undef _IMMINTRIN_H_INCLUDED
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace surefoot::detail {

// Sort keys are unsigned, AVX2 compares signed: both sides get their top bit flipped.
struct Avx2Keys {
  __m256i first;   // slots 0 to 7, flipped
  __m256i second;  // slots 8 to 15, flipped
};

/// The key of the input that the low four bits of each lane name (three bits, if all are in the first register).
template <bool TwoRegisters>
[[gnu::target("avx2"), gnu::always_inline]] inline __m256i select_keys(const Avx2Keys& keys, __m256i inputs) {
  __m256i selected = _mm256_permutevar8x32_epi32(keys.first, inputs);
  if constexpr (TwoRegisters) {
    const __m256i other = _mm256_permutevar8x32_epi32(keys.second, inputs);
    selected = _mm256_castps_si256(_mm256_blendv_ps(_mm256_castsi256_ps(selected), _mm256_castsi256_ps(other),
                                                    _mm256_castsi256_ps(_mm256_slli_epi32(inputs, 28))));
  }
  return selected;
}

/// At most 16 wide keys in two registers.
[[gnu::target("avx2"), gnu::always_inline]] inline Avx2Keys in_registers(std::span<const std::uint64_t> keys) {
  alignas(32) std::array<std::uint32_t, avx2_slots> slots{};
  for (std::size_t k = 0; k < keys.size(); ++k) slots[k] = static_cast<std::uint32_t>(keys[k] >> 32) ^ 0x80000000U;
  return {_mm256_load_si256(reinterpret_cast<const __m256i*>(&slots[0])),
          _mm256_load_si256(reinterpret_cast<const __m256i*>(&slots[8]))};
}

}  // namespace surefoot::detail

#endif

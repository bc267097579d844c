// Definitions of surefoot/forest/evaluate/descend_avx2.hpp.
#pragma once

#include "surefoot/forest/evaluate/avx2_keys.hpp"
#include "surefoot/forest/evaluate/descend_avx2.hpp"

#ifdef SUREFOOT_AVX2

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace surefoot::detail {

/// Eight descents.
struct Avx2Lanes {
  __m256i place;  // index of each lane's node
  __m256i key;    // its key, lanes in the order 0 1 4 5 2 3 6 7
  __m256i used;   // -1 where there is a tree
};

/// One step of 8 lanes; not zero if any moved.
template <bool TwoRegisters>
[[gnu::target("avx2"), gnu::always_inline]] inline __m256i step(const Node* nodes, const Avx2Keys& keys,
                                                                Avx2Lanes& lanes) {
  const auto* words = reinterpret_cast<const long long*>(nodes);
  // The mask is hidden from the compiler, which would otherwise leave the gather waiting for its target's old value.
  __m256i all = _mm256_set1_epi64x(-1);
  asm("" : "+x"(all));
  const __m256i zero = _mm256_setzero_si256();
  const __m256 low = _mm256_castsi256_ps(
      _mm256_mask_i32gather_epi64(zero, words, _mm256_castsi256_si128(lanes.place), all, sizeof(Node)));
  const __m256 high = _mm256_castsi256_ps(
      _mm256_mask_i32gather_epi64(zero, words, _mm256_extracti128_si256(lanes.place, 1), all, sizeof(Node)));
  const __m256i link = _mm256_castps_si256(_mm256_shuffle_ps(low, high, 0x88));
  lanes.key = _mm256_castps_si256(_mm256_shuffle_ps(low, high, 0xDD));
  const __m256i input = select_keys<TwoRegisters>(keys, link);
  const __m256i flip = _mm256_set1_epi32(static_cast<int>(0x80000000U));
  const __m256i greater = _mm256_cmpgt_epi32(input, _mm256_xor_si256(lanes.key, flip));  // -1 where true
  const __m256i moved = _mm256_sub_epi32(_mm256_srli_epi32(link, 8), greater);
  lanes.place = _mm256_add_epi32(lanes.place, _mm256_permute4x64_epi64(moved, 0xD8));  // back in order
  return moved;
}

/// At the roots of trees [first, first + 8) of `count`; lanes behind the last tree start at node 0 and are not used.
[[gnu::target("avx2"), gnu::always_inline]] inline Avx2Lanes start(const std::uint32_t* roots, std::size_t first,
                                                                   std::size_t count) {
  first = std::min(first, count);
  const auto left = static_cast<int>(std::min<std::size_t>(count - first, 8));
  Avx2Lanes lanes;
  lanes.used = _mm256_cmpgt_epi32(_mm256_set1_epi32(left), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  lanes.place = _mm256_maskload_epi32(reinterpret_cast<const int*>(roots + first), lanes.used);
  lanes.key = lanes.place;
  return lanes;
}
[[gnu::target("avx2"), gnu::always_inline]] inline void finish(const Avx2Lanes& lanes, std::uint32_t* payloads,
                                                               std::size_t first, std::size_t count) {
  first = std::min(first, count);
  _mm256_maskstore_epi32(reinterpret_cast<int*>(payloads + first), lanes.used,
                         _mm256_permute4x64_epi64(lanes.key, 0xD8));
}

template <bool TwoRegisters>
[[gnu::target("avx2")]] inline void find_leaves_avx2(const Node* nodes, std::span<const std::uint32_t> roots,
                                                     const Avx2Keys& keys, std::uint32_t* payloads) {
  const std::size_t count = roots.size();
  for (std::size_t tree = 0; tree < count; tree += avx2_trees) {
    Avx2Lanes a = start(roots.data(), tree, count);
    Avx2Lanes b = start(roots.data(), tree + 8, count);
    Avx2Lanes c = start(roots.data(), tree + 16, count);
    Avx2Lanes d = start(roots.data(), tree + 24, count);
    __m256i moved;
    do {
      moved = step<TwoRegisters>(nodes, keys, a) | step<TwoRegisters>(nodes, keys, b) |
              step<TwoRegisters>(nodes, keys, c) | step<TwoRegisters>(nodes, keys, d);
    } while (!_mm256_testz_si256(moved, moved));
    finish(a, payloads, tree, count);
    finish(b, payloads, tree + 8, count);
    finish(c, payloads, tree + 16, count);
    finish(d, payloads, tree + 24, count);
  }
}

template <bool TwoRegisters>
[[gnu::target("avx2")]] inline void take_steps_avx2(const Node* nodes, std::span<const std::uint32_t> roots,
                                                    const Avx2Keys& keys, std::size_t steps, std::uint32_t* reached) {
  const std::size_t count = roots.size();
  for (std::size_t tree = 0; tree < count; tree += avx2_trees) {
    Avx2Lanes a = start(roots.data(), tree, count);
    Avx2Lanes b = start(roots.data(), tree + 8, count);
    Avx2Lanes c = start(roots.data(), tree + 16, count);
    Avx2Lanes d = start(roots.data(), tree + 24, count);
    for (std::size_t i = 0; i < steps; ++i) {
      step<TwoRegisters>(nodes, keys, a);
      step<TwoRegisters>(nodes, keys, b);
      step<TwoRegisters>(nodes, keys, c);
      step<TwoRegisters>(nodes, keys, d);
    }
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(reached + tree), a.place);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(reached + tree + 8), b.place);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(reached + tree + 16), c.place);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(reached + tree + 24), d.place);
  }
}

[[gnu::target("avx2")]] SUREFOOT_INLINE void find_leaves_avx2(const Node* nodes, std::span<const std::uint32_t> roots,
                                                              std::span<const std::uint64_t> keys,
                                                              std::uint32_t* payloads) {
  const Avx2Keys registers = in_registers(keys);
  if (keys.size() <= 8) {
    find_leaves_avx2<false>(nodes, roots, registers, payloads);
  } else {
    find_leaves_avx2<true>(nodes, roots, registers, payloads);
  }
}

[[gnu::target("avx2")]] SUREFOOT_INLINE void take_steps_avx2(const Node* nodes, std::span<const std::uint32_t> roots,
                                                             std::span<const std::uint64_t> keys, std::size_t steps,
                                                             std::uint32_t* reached) {
  const Avx2Keys registers = in_registers(keys);
  if (keys.size() <= 8) {
    take_steps_avx2<false>(nodes, roots, registers, steps, reached);
  } else {
    take_steps_avx2<true>(nodes, roots, registers, steps, reached);
  }
}

}  // namespace surefoot::detail

#endif

// Definitions of surefoot/forest/evaluate/descend_blocks.hpp.
#pragma once

#include "surefoot/forest/evaluate/avx2_keys.hpp"
#include "surefoot/forest/evaluate/descend_blocks.hpp"

#ifdef SUREFOOT_AVX2

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace surefoot::detail {

inline const Block* block_at(const Block* blocks, PartReference part) {
  return blocks + (part & block_offset) / sizeof(Block);
}

/// The value of the exit by which an input leaves a part.
template <bool TwoRegisters>
[[gnu::target("avx2,bmi,bmi2"), gnu::always_inline]] inline std::uint32_t leave_part(const Block* blocks,
                                                                                     PartReference part,
                                                                                     const Avx2Keys& keys) {
  constexpr std::uint64_t in_each_byte = 0x0101010101010101U;
  const Block& block = *block_at(blocks, part);
  const __m256i shifts = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
  const __m256i inputs = _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(block.inputs)), shifts);
  // The six thresholds, and two exits, for which `passed` has no bits.
  const __m256i thresholds = _mm256_load_si256(reinterpret_cast<const __m256i*>(&block));
  const __m256i greater = _mm256_cmpgt_epi32(select_keys<TwoRegisters>(keys, inputs), thresholds);
  const auto right = static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(greater)));
  // Each byte is less than 128, so adding 127 sets the top bit of all but zeros.
  const std::uint64_t passed =
      (right * in_each_byte & std::bit_cast<std::uint64_t>(block.passed)) + 0x7F * in_each_byte;
  const std::uint64_t open = ~passed & (0x80 * in_each_byte << (part % 64));  // of this part and those behind it
  return block.exits[static_cast<std::size_t>(std::countr_zero(open)) / 8];
}

/// Every tree goes on by one part in turn, and the next one is fetched until it is its turn again: as many fetches are
/// in flight as trees go on. Trees that have come to their last part wait for the others there.
template <bool TwoRegisters>
[[gnu::target("avx2,bmi,bmi2")]] inline void find_leaves_in_blocks(const Block* blocks,
                                                                   std::span<const PartReference> roots,
                                                                   const Avx2Keys& keys, std::uint32_t* payloads) {
  std::array<PartReference, most_in_flight> last;  // of each tree, once it has come there
  std::array<PartReference, most_in_flight> part;
  std::array<std::uint32_t, most_in_flight> tree;  // of each part
  std::size_t underway = 0;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    last[i] = part[underway] = roots[i];
    tree[underway] = static_cast<std::uint32_t>(i);
    underway += (roots[i] & last_part) == 0 ? 1 : 0;
  }
  while (underway > 0) {
    const std::size_t count = std::exchange(underway, 0);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t at = tree[i];
      const PartReference next = leave_part<TwoRegisters>(blocks, part[i], keys);
      __builtin_prefetch(block_at(blocks, next));
      last[at] = part[underway] = next;
      tree[underway] = at;
      underway += (next & last_part) == 0 ? 1 : 0;
    }
  }
  for (std::size_t i = 0; i < roots.size(); ++i) payloads[i] = leave_part<TwoRegisters>(blocks, last[i], keys);
}

[[gnu::target("avx2,bmi,bmi2")]] SUREFOOT_INLINE void find_leaves_in_blocks(std::span<const Block> blocks,
                                                                            std::span<const PartReference> roots,
                                                                            std::span<const std::uint64_t> keys,
                                                                            std::uint32_t* payloads) {
  const Avx2Keys registers = in_registers(keys);
  if (keys.size() <= 8) {
    find_leaves_in_blocks<false>(blocks.data(), roots, registers, payloads);
  } else {
    find_leaves_in_blocks<true>(blocks.data(), roots, registers, payloads);
  }
}

}  // namespace surefoot::detail

#endif

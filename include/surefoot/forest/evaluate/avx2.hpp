// The switch for the ways down trees that are written with AVX2; they are chosen at run time.
//
// A program compiled with SUREFOOT_PORTABLE defined (in all of its files, or in none) does without: same predictions.
#pragma once

#include <cstddef>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(SUREFOOT_PORTABLE)
#define SUREFOOT_AVX2

namespace surefoot::detail {

constexpr std::size_t avx2_slots = 16;  // keys that fit into two registers, the slot behind the last included

}  // namespace surefoot::detail

#endif

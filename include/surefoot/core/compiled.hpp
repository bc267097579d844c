// The switch between headers alone and a compiled library.
//
// A header NAME.hpp whose functions do not depend on types of the user has their definitions in NAME.ipp. Headers alone
// (the default) include it, as inline functions. With SUREFOOT_COMPILED, which the CMake target surefoot::compiled
// sets, they do not: that library has the same definitions, compiled once from the same files.
#pragma once

#ifdef SUREFOOT_COMPILED
#define SUREFOOT_INLINE
#else
#define SUREFOOT_INLINE inline
#endif

/// For functions that run a few times in a program and not in its loops: compiled for size instead of speed, which
/// takes the compiler less time and memory.
#define SUREFOOT_ONCE [[gnu::cold]] SUREFOOT_INLINE

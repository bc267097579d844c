// The solution of small positive definite systems by Cholesky decomposition.
//
// The sums are taken in the order of Eigen's LLT for fewer than 32 unknowns, so that the results are equal to the last
// bit to those of the releases that used it; without its kernels for large matrices, which cost the compiler seconds.
#pragma once

#include <cstddef>
#include <span>

#include "surefoot/core/compiled.hpp"

namespace surefoot::detail {

/// Solves A X = B, A symmetric of `size` rows, column after column (its lower half is read and overwritten), B of
/// `columns` columns, overwritten by X. If A is not positive definite, X is of no use and may not be finite.
/// O(size^3 + size^2 columns).
void solve_positive_definite(std::span<double> a, std::size_t size, std::span<double> b, std::size_t columns);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/core/positive_definite.ipp"
#endif

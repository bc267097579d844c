// Products and decompositions of small matrices, compiled once: what least squares, CMA-ES and the fits of motion
// models share. Cost of each decomposition: of the order of n^3.
//
// The sums are taken in the order of Eigen 3.4's own decompositions, so that the results are equal to the last bit to
// those of the releases that used them, for up to 128 unknowns (31 for the Cholesky factor). Eigen's, which make a type
// of every expression, cost the compiler seconds and a tenth of its memory.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "surefoot/core/compiled.hpp"

namespace surefoot::detail {

/// The sum of a[i] b[i]: by four partial sums as Eigen's dot(), or by two as its products of a row with a vector.
double dot(const double* a, const double* b, Eigen::Index count);
double dot_by_two(const double* a, const double* b, Eigen::Index count);

/// A row or a column of a matrix, as a vector.
Eigen::VectorXd row_of(const Eigen::MatrixXd& a, Eigen::Index row);
Eigen::VectorXd column_of(const Eigen::MatrixXd& a, Eigen::Index column);

Eigen::VectorXd times(double factor, Eigen::VectorXd a);
double norm(const Eigen::VectorXd& a);
double sum_of_squares(const Eigen::VectorXd& a);
double column_norm(const Eigen::MatrixXd& a, Eigen::Index column);

/// Ones on the diagonal, zeros elsewhere.
Eigen::MatrixXd identity(Eigen::Index rows, Eigen::Index columns);

/// a b and a x, summed one product after the other (Eigen's bits below 20 rows, columns and products in all).
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd product(const Eigen::MatrixXd& a, const Eigen::VectorXd& x);

/// a + lower x, of the lower triangle of a matrix.
Eigen::VectorXd add_lower_product(Eigen::VectorXd a, const Eigen::MatrixXd& lower, const Eigen::VectorXd& x);

/// a^T, a^T b (each element a dot(); Eigen's bits as above) and a^T x.
Eigen::MatrixXd transposed(const Eigen::MatrixXd& a);
Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd transposed_product(const Eigen::MatrixXd& a, const Eigen::VectorXd& x);

/// a^T diag(weights) a: half of the products, and none of the rows at the ends of a column that are 0, as in
/// derivatives by what only one recording depends on.
Eigen::MatrixXd weighted_square(const Eigen::MatrixXd& a, const Eigen::VectorXd& weights);

/// diagonal a diagonal, for a diagonal matrix.
Eigen::MatrixXd scaled(const Eigen::VectorXd& diagonal, const Eigen::MatrixXd& a);

/// P a P^T = L D L^T: D on the diagonal, L below it, its diagonal of ones not stored; P swaps row k with row swaps[k],
/// from the first k on.
struct PivotedFactor {
  Eigen::MatrixXd lower;
  std::vector<Eigen::Index> swaps;
};

PivotedFactor factorise_with_pivots(const Eigen::MatrixXd& a);

/// Replaces x by the solution of a y = x, for a factorised `a`.
void solve_factorised(const PivotedFactor& factor, Eigen::VectorXd& x);

/// Solutions of a x = b for symmetric `a` (L D L^T with pivots): one per column of b.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::MatrixXd invert_symmetric(const Eigen::MatrixXd& a);

/// Replaces the lower triangle of `a` by its Cholesky factor; false if `a` is not positive definite.
bool factorise_in_place(Eigen::MatrixXd& a);

enum class DiagonalOf { any, ones };

/// Replaces x by the solution of lower y = x, or of lower^T y = x; what stands above the diagonal of `lower` is not
/// read, nor its diagonal if it is all ones.
void solve_lower(const Eigen::MatrixXd& lower, Eigen::VectorXd& x, DiagonalOf diagonal = DiagonalOf::any);
void solve_lower_transposed(const Eigen::MatrixXd& lower, Eigen::VectorXd& x, DiagonalOf diagonal = DiagonalOf::any);

/// The same for every column of a matrix.
void solve_lower(const Eigen::MatrixXd& lower, Eigen::MatrixXd& x, DiagonalOf diagonal = DiagonalOf::any);
void solve_lower_transposed(const Eigen::MatrixXd& lower, Eigen::MatrixXd& x, DiagonalOf diagonal = DiagonalOf::any);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/linear_algebra.ipp"
#endif

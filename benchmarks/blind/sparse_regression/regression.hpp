// Sparse regression by sequentially thresholded least squares, after S. L. Brunton, J. L. Proctor and J. N. Kutz:
// "Discovering governing equations from data by sparse identification of nonlinear dynamical systems", PNAS 113, 2016.
#pragma once

#include <vector>

#include "plant.hpp"

namespace sparse {

/// Columns of candidate terms and what they shall explain, row by row. The first `kept` columns are never dropped.
struct Rows {
  std::vector<plants::Column> columns;
  plants::Column target;
  std::size_t kept = 0;
};

struct Fit {
  plants::Values coefficients;  // zero: dropped
  double threshold = 0;
  double before = 0, after = 0;  // root mean square error on the held-out rows: kept columns alone, all chosen
};

/// The threshold is the one that does best on `check`; within 2 % of the best, the sparsest.
Fit regress(const Rows& rows, const Rows& check);

}  // namespace sparse

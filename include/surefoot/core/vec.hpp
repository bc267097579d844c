// Fixed-size column vectors of double: the states, actions and points of everything else.
#pragma once

#include <Eigen/Core>

namespace surefoot {

/// Column vector of N doubles; N may be Eigen::Dynamic.
template <int N>
using Vec = Eigen::Matrix<double, N, 1>;

}  // namespace surefoot

// The natural cubic spline through the rows of a column: what a band-limited signal was between them, within 1 % up to
// a quarter of the sampling rate. M. Unser: "Splines: a perfect fit for signal and image processing", IEEE Signal
// Processing Magazine 16(6), 1999.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace surefoot::diagnosis {

/// Second derivatives at the rows of the spline through `values` at rising `times` [s]; 0 at both ends. Empty for fewer
/// than three rows, between which it is straight. O(rows).
std::vector<double> second_derivatives(const Eigen::VectorXd& times, const Eigen::VectorXd& values);

/// By how much the spline differs from the straight line between two rows, at `share` of the interval [s].
inline double bend_between(double first, double second, double interval, double share) {
  const double rest = 1 - share;
  return ((rest * rest * rest - rest) * first + (share * share * share - share) * second) * interval * interval / 6;
}

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/simulation/cubic_spline.ipp"
#endif

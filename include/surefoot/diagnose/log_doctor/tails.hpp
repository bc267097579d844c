// Tails of Student's t and Fisher's F distribution.
#pragma once

#include <cmath>
#include <limits>

namespace surefoot::diagnosis {

/// Probability that an F-distributed value with d1 and d2 degrees of freedom exceeds f, by the incomplete beta function
/// and its continued fraction (Abramowitz & Stegun 1964, 26.5.8 and 26.6.2).
double f_tail(double f, double d1, double d2);

/// Probability that a t-distributed value exceeds |t| on either side.
inline double t_tail(double t, double dof) { return f_tail(t * t, 1, dof); }

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/tails.ipp"
#endif

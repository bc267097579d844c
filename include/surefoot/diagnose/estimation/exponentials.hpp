// Exponentials and logarithms of the elements of vectors, as Eigen 3.4 computes them: two or more at a time, which is
// not to the last bit what the standard library gives.
#pragma once

#include <Eigen/Core>

#include "surefoot/core/compiled.hpp"

namespace surefoot::diagnosis {

Eigen::VectorXd exponentials(const Eigen::VectorXd& x);
Eigen::VectorXd logarithms(const Eigen::VectorXd& x);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/exponentials.ipp"
#endif

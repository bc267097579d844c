// Definitions of surefoot/diagnose/estimation/exponentials.hpp.
#pragma once

#include <Eigen/Core>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/exponentials.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE Eigen::VectorXd exponentials(const Eigen::VectorXd& x) { return x.array().exp(); }
SUREFOOT_INLINE Eigen::VectorXd logarithms(const Eigen::VectorXd& x) { return x.array().log(); }

}  // namespace surefoot::diagnosis

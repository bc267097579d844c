// One low-pass filter for recorded and modelled torques alike: what both sides lose is no error, and the noise of
// accelerations, which grows with the square of the frequency, goes. The "parallel filtering" of identification
// (Gautier, "Dynamic identification of robots with power model", ICRA 1997).
#pragma once

#include <Eigen/SparseCore>
#include <functional>

#include "motion.hpp"

namespace diagnose_robot {

using LowPass = Eigen::SparseMatrix<double, Eigen::RowMajor>;  // row x row

/// Weighted means over `width` [s] to either side, of the rows that are known alone: not NaN in `torque`. Rows that are
/// not known have none.
LowPass low_pass(const Eigen::VectorXd& time, double width, const Eigen::Ref<const Eigen::VectorXd>& torque);

/// One column of torques; NaN stays NaN.
Eigen::VectorXd low_passed(const Eigen::VectorXd& time, double width, const Eigen::Ref<const Eigen::VectorXd>& torque);

/// All columns, each by the filter of its joint.
Eigen::MatrixXd low_passed(const Motion& motion, Eigen::MatrixXd torques);

struct LowPassCriteria {
  double noise = 0.01;  // of the accelerations: no drive repeats better, and a wider filter only costs rows
  double kept = 0.9;    // of the variance of the torque: effects keep as much of theirs
  double narrowest = 0.02, widest = 0.2;  // [s], as for angles
  double wider = 1.4;                     // times the one before
};

/// [s], the narrowest filter of a joint that leaves accelerations no more noise than matters, but none that takes more
/// of the torque than it may. `noise_share`: of the accelerations behind a filter of a width, in units of them.
double low_pass_width(const Eigen::VectorXd& time, const Eigen::Ref<const Eigen::VectorXd>& torque,
                      const std::function<double(double)>& noise_share, const LowPassCriteria& criteria = {});

}  // namespace diagnose_robot

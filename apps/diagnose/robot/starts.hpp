// Where simulations of recordings begin. Angles and speeds of the first row are read with errors, which a drive soon
// corrects, but one that is at its limit does not: for as long as a motion does not forget its start, the start is fitted
// along with the terms, recording by recording, and is no evidence for or against any of them.
#pragma once

#include "linearize.hpp"

namespace diagnose_robot {

/// Standard deviations of what the first row of a recording says of angles and speeds: noise of sensors through the
/// filter, and what accelerations change within its window.
StartState start_deviation(const Evidence& evidence, std::size_t recording);

/// -2 log of the density of these starts, by recording, up to a constant.
double start_cost(const Evidence& evidence, const std::vector<StartState>& starts);

/// One recording, and the joints that move each other in it. `columns`, `errors`: by joint, as in the model, and
/// `by_start` their derivatives by the start (place x rows of the recording, 2 * joints); `weight`: by joint, of squared
/// errors. Replaces the recording's rows of columns and errors, from row `first` on, by those with the start that fits
/// best for any change of terms. Cost: rows * joints * (terms + starts) * starts.
StartFit eliminate_start(const std::vector<int>& joints, const std::vector<Eigen::MatrixXd>& by_start,
                         const Eigen::VectorXd& deviation, const Eigen::VectorXd& from_read,
                         const Eigen::VectorXd& weight, Eigen::Index first, std::vector<Eigen::MatrixXd>& columns,
                         std::vector<Eigen::VectorXd>& errors);

/// The starts that go with this share of a change of terms.
std::vector<StartState> moved_starts(const LinearModel& model, std::vector<StartState> starts,
                                     const Eigen::VectorXd& change, double share = 1);

/// Starts fitted to recordings with physics as they are.
std::vector<StartState> fitted_starts(const Evidence& evidence, const RobotPhysics& physics);

}  // namespace diagnose_robot

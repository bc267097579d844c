#include "starts.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "search_point.hpp"

namespace diagnose_robot {

StartState start_deviation(const Evidence& evidence, std::size_t recording) {
  const Motion& motion = evidence.motions[recording];
  const auto joints = static_cast<Eigen::Index>(evidence.robot.joints.size());
  StartState result{Eigen::VectorXd(joints), Eigen::VectorXd(joints)};
  for (Eigen::Index j = 0; j < joints; ++j) {
    const double noise = noise_of(evidence.recordings[recording].angle.col(j));
    const double within = evidence.scales[static_cast<std::size_t>(j)].acceleration * motion.reach;
    result.angle[j] = std::hypot(noise, within * motion.reach / 2);
    result.speed[j] = std::hypot(noise * motion.start_gain, within);
  }
  return result;
}

double start_cost(const Evidence& evidence, const std::vector<StartState>& starts) {
  double sum = 0;
  for (std::size_t r = 0; r < starts.size(); ++r) {
    const StartState read = start_of(evidence.motions[r]), deviation = start_deviation(evidence, r);
    sum += (starts[r].angle - read.angle).cwiseQuotient(deviation.angle).squaredNorm() +
           (starts[r].speed - read.speed).cwiseQuotient(deviation.speed).squaredNorm();
  }
  return sum;
}

StartFit eliminate_start(const std::vector<int>& joints, const std::vector<Eigen::MatrixXd>& by_start,
                         const Eigen::VectorXd& deviation, const Eigen::VectorXd& from_read,
                         const Eigen::VectorXd& weight, Eigen::Index first, std::vector<Eigen::MatrixXd>& columns,
                         std::vector<Eigen::VectorXd>& errors) {
  const Eigen::VectorXd precision = deviation.cwiseAbs2().cwiseInverse();
  const Eigen::Index terms = columns[static_cast<std::size_t>(joints.front())].cols();
  Eigen::MatrixXd q = precision.asDiagonal();
  Eigen::VectorXd c = precision.cwiseProduct(from_read);
  Eigen::MatrixXd by_term = Eigen::MatrixXd::Zero(q.rows(), terms);
  for (std::size_t p = 0; p < joints.size(); ++p) {
    const auto j = static_cast<std::size_t>(joints[p]);
    const Eigen::MatrixXd weighted = weight[joints[p]] * by_start[p].transpose();
    q.noalias() += weighted * by_start[p];
    c.noalias() += weighted * errors[j].segment(first, by_start[p].rows());
    by_term.noalias() += weighted * columns[j].middleRows(first, by_start[p].rows());
  }
  const Eigen::VectorXd scale = q.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Eigen::MatrixXd> solver(Eigen::MatrixXd(scale.asDiagonal() * q * scale.asDiagonal()));
  StartFit fit;
  fit.joints = joints;
  fit.change = -scale.cwiseProduct(solver.solve(scale.cwiseProduct(c)));
  fit.by_term = -(scale.asDiagonal() * solver.solve(scale.asDiagonal() * by_term));
  for (std::size_t p = 0; p < joints.size(); ++p) {
    const auto j = static_cast<std::size_t>(joints[p]);
    errors[j].segment(first, by_start[p].rows()).noalias() += by_start[p] * fit.change;
    columns[j].middleRows(first, by_start[p].rows()).noalias() += by_start[p] * fit.by_term;
  }
  return fit;
}

std::vector<StartState> moved_starts(const LinearModel& model, std::vector<StartState> starts,
                                     const Eigen::VectorXd& change, double share) {
  for (const StartFit& fit : model.starts) {
    const Eigen::VectorXd moved = share * (fit.change + fit.by_term * change(fit.terms));
    const auto size = static_cast<Eigen::Index>(fit.joints.size());
    starts[fit.recording].angle(fit.joints) += moved.head(size);
    starts[fit.recording].speed(fit.joints) += moved.tail(size);
  }
  return starts;
}

std::vector<StartState> fitted_starts(const Evidence& evidence, const RobotPhysics& physics) {
  constexpr int most_moves = 10;
  if (evidence.robot.setup.drive == DriveKind::torque) return evidence.starts;
  Evidence own = evidence;
  own.base = physics;
  own.terms.clear();
  own.entries.clear();
  Point point{{}, {}, evidence.starts, errors_of(evidence, physics)};
  RigidCache cache;
  for (int k = 0; k < most_moves; ++k) {
    const LinearModel here = linearize(own, point.theta, point.starts, point.errors, cache);
    if (!move(own, here, {}, {}, point)) break;
  }
  return point.starts;
}

}  // namespace diagnose_robot

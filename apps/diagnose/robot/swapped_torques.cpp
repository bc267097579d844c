#include "swapped_torques.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "choose_terms.hpp"
#include "low_pass.hpp"
#include "torque_residual.hpp"

namespace diagnose_robot {
namespace {

constexpr double smallest_variance = 1e-12;  // relative: rounding

// What moves a joint, and its torque in the last column, through one filter; rows that say nothing are left out.
Eigen::MatrixXd features_of(const Motion& motion, const Eigen::MatrixXd& bodies, const Eigen::MatrixXd& left,
                            Eigen::Index j) {
  Eigen::MatrixXd x(motion.q.rows(), 6);
  x << Eigen::VectorXd::Ones(motion.q.rows()), motion.v.col(j), motion.v.col(j).cwiseSign(), motion.a.col(j),
      bodies.col(j), motion.torque.col(j);
  std::vector<Eigen::Index> known;
  for (Eigen::Index k = 0; k < x.rows(); ++k) {
    if (std::isfinite(left(k, j))) known.push_back(k);
  }
  const Eigen::MatrixXd filtered = low_pass(motion.time, motion.low_pass[j], left.col(j)) * x;
  return filtered(known, Eigen::all);
}

TorqueMisfit misfit_of(const std::vector<Eigen::MatrixXd>& recordings) {
  Eigen::Index rows = 0;
  for (const Eigen::MatrixXd& one : recordings) rows += one.rows();
  if (rows <= 6) return {1, 0};
  Eigen::MatrixXd x(rows, 5);
  Eigen::VectorXd torque(rows);
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& one : recordings) {
    x.middleRows(at, one.rows()) = one.leftCols(5);
    torque.segment(at, one.rows()) = one.col(5);
    at += one.rows();
  }
  torque.array() -= torque.mean();
  const Eigen::VectorXd left = torque - x * x.colPivHouseholderQr().solve(torque);
  return {left.squaredNorm() / std::max(1e-300, torque.squaredNorm()), independent_errors(left)};
}

double evidence_of(const TorqueMisfit& as_is, const TorqueMisfit& swapped) {
  return std::min(as_is.independent, swapped.independent) *
         std::log(std::max(smallest_variance, as_is.variance) / std::max(smallest_variance, swapped.variance));
}

}  // namespace

std::vector<TorqueMisfit> torque_misfits(const Evidence& evidence, int a, int b) {
  const std::size_t joints = evidence.robot.joints.size();
  std::vector<std::vector<Eigen::MatrixXd>> features(joints);
  for (const Motion& recorded : evidence.motions) {
    Motion motion = recorded;
    for (Eigen::MatrixXd* matrix : {&motion.q, &motion.v, &motion.a}) {
      if (a != b) matrix->col(a).swap(matrix->col(b));
    }
    const Eigen::MatrixXd bodies = rigid_body_torque(evidence.robot, motion, evidence.robot.nominal);
    const Eigen::MatrixXd left = torque_residual(evidence.robot, motion, evidence.robot.nominal);
    for (std::size_t j = 0; j < joints; ++j)
      features[j].push_back(features_of(motion, bodies, left, static_cast<Eigen::Index>(j)));
  }
  std::vector<TorqueMisfit> result;
  for (std::size_t j = 0; j < joints; ++j)
    result.push_back(evidence.silent[j] != 0 ? TorqueMisfit{1, 0} : misfit_of(features[j]));
  return result;
}

SwappedAngles compare_swapped(int a, int b, const std::vector<TorqueMisfit>& as_is,
                              const std::vector<TorqueMisfit>& swapped) {
  SwappedAngles result{a, b, 0, false};
  for (std::size_t j = 0; j < as_is.size(); ++j) result.evidence += evidence_of(as_is[j], swapped[j]);
  const auto alone = [&](int j) {
    return evidence_of(as_is[static_cast<std::size_t>(j)], swapped[static_cast<std::size_t>(j)]) > 0;
  };
  result.each_alone = alone(a) && alone(b);
  return result;
}

std::vector<std::pair<int, int>> likely_swaps(std::vector<SwappedAngles> candidates) {
  const double choice = 2 * std::log(std::max<double>(1, static_cast<double>(candidates.size())));
  std::ranges::stable_sort(candidates, std::ranges::greater{}, &SwappedAngles::evidence);
  std::vector<std::pair<int, int>> pairs;
  for (const SwappedAngles& one : candidates) {
    if (!one.each_alone || one.evidence < ChoiceCriteria().needed + choice) continue;
    const bool taken = std::ranges::any_of(pairs, [&](const std::pair<int, int>& pair) {
      return pair.first == one.a || pair.first == one.b || pair.second == one.a || pair.second == one.b;
    });
    if (!taken) pairs.emplace_back(one.a, one.b);
  }
  return pairs;
}

std::vector<std::pair<int, int>> swapped_torques(const Evidence& evidence) {
  const auto joints = static_cast<int>(evidence.robot.joints.size());
  const std::vector<TorqueMisfit> as_is = torque_misfits(evidence);
  std::vector<std::pair<int, int>> all;
  for (int a = 0; a < joints; ++a) {
    for (int b = a + 1; b < joints; ++b) all.emplace_back(a, b);
  }
  return likely_swaps(surefoot::map(
      evidence.threads, all.size(),
      [&](std::size_t i) {
        const auto& [a, b] = all[i];
        return compare_swapped(a, b, as_is, torque_misfits(evidence, a, b));
      },
      evidence.stop));
}

}  // namespace diagnose_robot

#include "linearize.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "simulate_robot.hpp"
#include "surefoot/core/error.hpp"
#include "torque_residual.hpp"

namespace diagnose_robot {
namespace {

constexpr int block_count = 5;  // held-out blocks of a single recording: each a fifth, as in five-fold cross-validation
constexpr double step_share = 0.2;   // of a typical size: differences beyond rounding and single reversals
constexpr double prior_share = 0.5;  // of the bounds of a property of drives and joints: hardly a prior
// Of a typical size: 1 % of the torque of a drive, of a gain or a mass. No drive repeats better, and two simulations of
// one model differ by such amounts.
constexpr double smallest_share = 0.1;
constexpr double stated_prior = 2;  // typical sizes: a gain or mass that is stated is rarely off by more than some 20 %

double rms(const Eigen::Ref<const Eigen::VectorXd>& x) {
  return std::sqrt(x.squaredNorm() / static_cast<double>(x.size()));
}

// Terms whose changes one evaluation can show: the same property at joints of different trees.
std::vector<std::vector<std::size_t>> batches(const Evidence& evidence, const TermSet& wanted) {
  std::vector<std::vector<std::size_t>> result;
  std::vector<std::vector<char>> used;  // by batch and tree
  for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
    if (wanted[t] == 0) continue;
    const Term& term = evidence.terms[t];
    std::size_t b = 0;
    const auto clashes = [&](std::size_t batch) {
      if (evidence.terms[result[batch].front()].property != term.property) return true;
      return std::ranges::any_of(term.joints, [&](int j) {
        return used[batch][static_cast<std::size_t>(evidence.robot.joints[static_cast<std::size_t>(j)].tree)] != 0;
      });
    };
    while (b < result.size() && clashes(b)) ++b;
    if (b == result.size()) {
      result.emplace_back();
      used.emplace_back(static_cast<std::size_t>(evidence.robot.trees), 0);
    }
    result[b].push_back(t);
    for (const int j : term.joints)
      used[b][static_cast<std::size_t>(evidence.robot.joints[static_cast<std::size_t>(j)].tree)] = 1;
  }
  return result;
}

double step_of(const Term& term, double theta) {
  const double step = step_share * term.typical;
  return theta + step <= term.high ? step : -step;
}

bool moves(const Evidence& evidence, const Term& term, std::size_t joint) {
  const int tree = evidence.robot.joints[joint].tree;
  return std::ranges::any_of(term.joints,
                             [&](int j) { return evidence.robot.joints[static_cast<std::size_t>(j)].tree == tree; });
}

// Errors that all terms together would leave: only these are noise, whose correlation says how many rows count. What a
// term takes away is no noise, however slowly it changes.
Eigen::VectorXd left_by_all(const Evidence& evidence, const Eigen::MatrixXd& x, const Eigen::VectorXd& r,
                            const Eigen::Ref<const Eigen::VectorXd>& errors) {
  constexpr double ridge = 1e-3;  // of the error itself: terms within their typical sizes times some ten
  const double noise = r.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, r.size()));
  Eigen::MatrixXd gram = x.transpose() * x;
  for (Eigen::Index t = 0; t < gram.rows(); ++t) {
    const double typical = evidence.terms[static_cast<std::size_t>(t)].typical;
    gram(t, t) += ridge * noise / (typical * typical) + 1e-300;
  }
  const Eigen::VectorXd scale = gram.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * gram * scale.asDiagonal();
  const Eigen::VectorXd change = scale.cwiseProduct(scaled.ldlt().solve(-scale.cwiseProduct(x.transpose() * r)));
  Eigen::VectorXd left = r + x * change;
  for (Eigen::Index k = 0; k < left.size(); ++k) {
    if (!std::isfinite(errors[k])) left[k] = std::nan("");
  }
  return left;
}

void set_priors(const Evidence& evidence, LinearModel& model) {
  const auto count = static_cast<Eigen::Index>(evidence.terms.size());
  for (Eigen::VectorXd* vector : {&model.low, &model.high, &model.prior, &model.smallest, &model.cost})
    vector->resize(count);
  for (Eigen::Index t = 0; t < count; ++t) {
    const Term& term = evidence.terms[static_cast<std::size_t>(t)];
    const PropertyInfo& info = info_of(term.property);
    const bool stated =
        info.calibration || term.property == Property::torque_gain || term.property == Property::sensor_bias;
    model.low[t] = term.low;
    if (info.low >= 0) {  // with what the file and its group have not below 0
      model.low[t] = -nominal_of(evidence.robot, term);
      for (Eigen::Index other = 0; other < count && term.group == single_joint; ++other) {
        const Term& tied = evidence.terms[static_cast<std::size_t>(other)];
        if (tied.property != term.property || tied.group == single_joint) continue;
        if (std::ranges::find(tied.joints, term.joints.front()) != tied.joints.end())
          model.low[t] -= model.theta[other];
      }
    }
    model.high[t] = term.high;
    model.prior[t] = stated ? stated_prior * term.typical : prior_share * std::max(term.high, -term.low);
    model.smallest[t] = smallest_share * term.typical;
    double independent = 0;
    for (const int j : term.joints) independent += model.independent[j];
    // Schwarz's log n for the parameter, and the choice among so many terms (extended BIC of Chen and Chen, 2008).
    model.cost[t] = std::log(independent) + 2 * std::log(static_cast<double>(count));
    model.acts_on.push_back(term.joints);
  }
}

// Torques that are the same in most rows are no readings.
void find_silent(Evidence& evidence) {
  constexpr double still = 0.5;  // of the rows: a drive that moves never gives one torque for so long
  evidence.silent.assign(evidence.robot.joints.size(), 0);
  if (evidence.robot.setup.drive != DriveKind::torque) return;
  for (std::size_t j = 0; j < evidence.silent.size(); ++j) {
    std::map<double, double> count;
    double rows = 0, most = 0;
    for (const RobotRecording& recording : evidence.recordings) {
      for (const double torque : recording.torque.col(static_cast<Eigen::Index>(j)))
        most = std::max(most, count[torque] += 1);
      rows += static_cast<double>(recording.time.size());
    }
    evidence.silent[j] = most > still * rows ? 1 : 0;
  }
}

}  // namespace

void prepare(Evidence& evidence) {
  const bool single = evidence.recordings.size() == 1;
  evidence.blocks = single ? block_count : static_cast<int>(evidence.recordings.size());
  for (std::size_t r = 0; r < evidence.recordings.size(); ++r) {
    const Eigen::Index rows = evidence.recordings[r].time.size();
    for (Eigen::Index k = 0; k < rows; ++k) {
      evidence.block.push_back(single ? static_cast<int>(k * block_count / rows) : static_cast<int>(r));
    }
  }
  const std::size_t joints = evidence.robot.joints.size();
  find_silent(evidence);
  evidence.scales.resize(joints);
  const mjModel* m = evidence.robot.model.model.get();
  for (std::size_t j = 0; j < joints; ++j) {
    JointScale& scale = evidence.scales[j];
    double torque = 0, reading = 0, speed = 0, acceleration = 0, angle = 0;
    for (const Motion& motion : evidence.motions) {
      const auto c = static_cast<Eigen::Index>(j);
      const Eigen::VectorXd given = drive_torque(evidence.robot, motion).col(c);
      reading = std::max(reading, rms(given));
      torque =
          std::max({torque, rms(given), rms(rigid_body_torque(evidence.robot, motion, RobotPhysics(joints)).col(c))});
      speed = std::max(speed, rms(motion.v.col(c)));
      acceleration = std::max(acceleration, rms(motion.a.col(c)));
      angle = std::max(angle, rms((motion.q.col(c).array() - motion.q.col(c).mean()).matrix()));
    }
    constexpr double still = 1e-3;  // [rad], [rad/s], ...: a joint that hardly moves
    scale = {std::max(still, torque),
             std::max(still, speed),
             std::max(still, acceleration),
             std::max(still, angle),
             std::max(still, reading),
             0.1,
             1};
    const ModelJoint& joint = evidence.robot.joints[j].model;
    const double size = std::hypot(joint.tip[0], joint.tip[1], joint.tip[2]);
    if (size > 0) scale.link_size = size;
    if (m->body_mass[joint.body] > 0) scale.link_mass = m->body_mass[joint.body];
  }
  evidence.terms = all_terms(evidence.robot, evidence.scales);
}

void leave_out_start(const Robot& robot, const RobotRecording& recording, Eigen::Ref<Eigen::MatrixXd> errors) {
  constexpr double settling = 0.5,
                   share = 0.1;  // [s], of the length at most: speeds and what was told before are not known
  if (robot.setup.drive == DriveKind::torque) return;
  const double length = recording.time[recording.time.size() - 1] - recording.time[0];
  for (Eigen::Index k = 0;
       k < errors.rows() && recording.time[k] - recording.time[0] < std::min(settling, share * length); ++k) {
    errors.row(k).setConstant(std::nan(""));
  }
}

Eigen::MatrixXd errors_of(const Evidence& evidence, const RobotPhysics& physics) {
  Eigen::MatrixXd errors(static_cast<Eigen::Index>(evidence.block.size()),
                         static_cast<Eigen::Index>(evidence.robot.joints.size()));
  Eigen::Index at = 0;
  for (std::size_t r = 0; r < evidence.recordings.size(); ++r) {
    const RobotRecording& recording = evidence.recordings[r];
    const Eigen::Index rows = recording.time.size();
    errors.middleRows(at, rows) =
        evidence.robot.setup.drive == DriveKind::torque
            ? torque_residual(evidence.robot, evidence.motions[r], physics)
            : Eigen::MatrixXd(recording.angle -
                              simulate_robot(evidence.robot, recording, start_of(evidence.motions[r]), physics));
    leave_out_start(evidence.robot, recording, errors.middleRows(at, rows));
    at += rows;
  }
  for (std::size_t j = 0; j < evidence.silent.size(); ++j) {
    if (evidence.silent[j] != 0) errors.col(static_cast<Eigen::Index>(j)).setConstant(std::nan(""));
  }
  return errors;
}

namespace {

void take_derivatives(const Evidence& evidence, const Eigen::VectorXd& theta, const Eigen::MatrixXd& errors,
                      const TermSet& terms, Derivatives& derivatives) {
  const std::size_t joints = evidence.robot.joints.size();
  const auto groups = batches(evidence, terms);
  const auto changed = surefoot::map(
      evidence.threads, groups.size(),
      [&](std::size_t b) {
        Eigen::VectorXd moved = theta;
        for (const std::size_t t : groups[b])
          moved[static_cast<Eigen::Index>(t)] += step_of(evidence.terms[t], theta[static_cast<Eigen::Index>(t)]);
        return errors_of(evidence, physics_of(evidence.terms, moved, evidence.robot.nominal));
      },
      evidence.stop);
  for (std::size_t b = 0; b < groups.size(); ++b) {
    for (const std::size_t t : groups[b]) {
      Eigen::MatrixXd& of = derivatives.of[t];
      of = Eigen::MatrixXd::Zero(errors.rows(), errors.cols());
      const double step = step_of(evidence.terms[t], theta[static_cast<Eigen::Index>(t)]);
      for (std::size_t j = 0; j < joints; ++j) {
        const auto c = static_cast<Eigen::Index>(j);
        if (moves(evidence, evidence.terms[t], j)) of.col(c) = (changed[b].col(c) - errors.col(c)) / step;
      }
      derivatives.fresh[t] = 1;
    }
  }
}

// Sums of one joint by block; rows that are not known count nothing.
void add_blocks(const Evidence& evidence, Eigen::MatrixXd& x, Eigen::VectorXd& r, std::vector<Sums>& sums) {
  for (Eigen::Index k = 0; k < r.size(); ++k) {
    if (std::isfinite(r[k]) && x.row(k).allFinite()) continue;
    r[k] = 0;
    x.row(k).setZero();
  }
  for (Eigen::Index begin = 0; begin < r.size();) {
    const int block = evidence.block[static_cast<std::size_t>(begin)];
    Eigen::Index end = begin;
    while (end < r.size() && evidence.block[static_cast<std::size_t>(end)] == block) ++end;
    Sums& sum = sums[static_cast<std::size_t>(block)];
    const auto part = x.middleRows(begin, end - begin);
    sum.gram = Eigen::MatrixXd::Zero(x.cols(), x.cols());
    sum.gram.selfadjointView<Eigen::Lower>().rankUpdate(part.transpose());
    sum.gram.triangularView<Eigen::StrictlyUpper>() = sum.gram.transpose();
    sum.slope = part.transpose() * r.segment(begin, end - begin);
    sum.square = r.segment(begin, end - begin).squaredNorm();
    sum.rows = static_cast<double>(end - begin);
    begin = end;
  }
}

}  // namespace

LinearModel linearize(const Evidence& evidence, const Eigen::VectorXd& theta, const Eigen::MatrixXd& errors,
                      const TermSet& wanted, const TermSet& renewed, Derivatives& derivatives) {
  const std::size_t joints = evidence.robot.joints.size(), terms = evidence.terms.size();
  derivatives.of.resize(terms);
  derivatives.fresh.assign(terms, 0);
  TermSet now(terms, 0);
  for (std::size_t t = 0; t < terms; ++t)
    now[t] = renewed[t] != 0 || (wanted[t] != 0 && derivatives.of[t].size() == 0) ? 1 : 0;
  take_derivatives(evidence, theta, errors, now, derivatives);
  LinearModel model;
  model.theta = theta;
  for (const RobotJoint& joint : evidence.robot.joints) model.pool.push_back(joint.group);
  model.independent.resize(static_cast<Eigen::Index>(joints));
  model.sums.assign(joints, std::vector<Sums>(static_cast<std::size_t>(evidence.blocks)));
  for (std::size_t j = 0; j < joints; ++j) {
    const auto c = static_cast<Eigen::Index>(j);
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(errors.rows(), static_cast<Eigen::Index>(terms));
    for (std::size_t t = 0; t < terms; ++t) {
      if (wanted[t] != 0) x.col(static_cast<Eigen::Index>(t)) = derivatives.of[t].col(c);
    }
    Eigen::VectorXd r = errors.col(c);
    add_blocks(evidence, x, r, model.sums[j]);
    model.independent[c] = independent_errors(left_by_all(evidence, x, r, errors.col(c)));
  }
  set_priors(evidence, model);
  add_up(model);
  return model;
}

Eigen::VectorXd rms_by_joint(const Evidence& evidence, const Eigen::MatrixXd& errors, int block) {
  Eigen::VectorXd square = Eigen::VectorXd::Zero(errors.cols()), rows = square;
  for (Eigen::Index j = 0; j < errors.cols(); ++j) {
    for (Eigen::Index k = 0; k < errors.rows(); ++k) {
      if ((block >= 0 && evidence.block[static_cast<std::size_t>(k)] != block) || std::isnan(errors(k, j))) continue;
      square[j] += errors(k, j) * errors(k, j);
      rows[j] += 1;
    }
  }
  return (square.array() / rows.array().max(1)).sqrt();
}

}  // namespace diagnose_robot

#include "linearize.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "inverse_dynamics.hpp"
#include "low_pass.hpp"
#include "simulate_robot.hpp"
#include "starts.hpp"
#include "surefoot/core/error.hpp"
#include "term_priors.hpp"
#include "torque_residual.hpp"

namespace diagnose_robot {
namespace {

constexpr int block_count = 5;  // held-out blocks of a single recording: each a fifth, as in five-fold cross-validation

double rms(const Eigen::Ref<const Eigen::VectorXd>& x) {
  return std::sqrt(x.squaredNorm() / static_cast<double>(x.size()));
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
  evidence.block.clear();
  evidence.blocks = single ? block_count : static_cast<int>(evidence.recordings.size());
  for (std::size_t r = 0; r < evidence.recordings.size(); ++r) {
    const Eigen::Index rows = evidence.recordings[r].time.size();
    for (Eigen::Index k = 0; k < rows; ++k) {
      evidence.block.push_back(single ? static_cast<int>(k * block_count / rows) : static_cast<int>(r));
    }
  }
  evidence.starts.clear();
  for (const Motion& motion : evidence.motions) evidence.starts.push_back(start_of(motion));
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
    constexpr double still = 1e-3;        // [rad], [rad/s], ...: a joint that hardly moves
    constexpr double angle_share = 0.02;  // of the way that a slide moves: offsets
    scale = {std::max(still, torque),
             std::max(still, speed),
             std::max(still, acceleration),
             std::max(still, angle),
             std::max(still, reading),
             0.1,
             1};
    scale.row = evidence.recordings.front().row_period();
    const ModelJoint& joint = evidence.robot.joints[j].model;
    if (joint.slides) scale.offset = std::max(still, angle_share * angle);
    const double size = std::hypot(joint.tip[0], joint.tip[1], joint.tip[2]);
    if (size > 0) scale.link_size = size;
    if (m->body_mass[joint.body] > 0) scale.link_mass = m->body_mass[joint.body];
  }
  evidence.terms = all_terms(evidence.robot, evidence.scales);
  evidence.entries = entries_of(evidence.terms);
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
  return errors_of(evidence, physics, evidence.starts);
}

Eigen::MatrixXd errors_of(const Evidence& evidence, const RobotPhysics& physics,
                          const std::vector<StartState>& starts) {
  Eigen::MatrixXd errors(static_cast<Eigen::Index>(evidence.block.size()),
                         static_cast<Eigen::Index>(evidence.robot.joints.size()));
  Eigen::Index at = 0;
  for (std::size_t r = 0; r < evidence.recordings.size(); ++r) {
    const RobotRecording& recording = evidence.recordings[r];
    const Eigen::Index rows = recording.time.size();
    errors.middleRows(at, rows) =
        evidence.robot.setup.drive == DriveKind::torque
            ? low_passed(evidence.motions[r], torque_residual(evidence.robot, evidence.motions[r], physics))
            : Eigen::MatrixXd(recording.angle -
                              simulate_robot(evidence.robot, recording, starts[r], physics));
    leave_out_start(evidence.robot, recording, errors.middleRows(at, rows));
    at += rows;
  }
  for (std::size_t j = 0; j < evidence.silent.size(); ++j) {
    if (evidence.silent[j] != 0) errors.col(static_cast<Eigen::Index>(j)).setConstant(std::nan(""));
  }
  return errors;
}

namespace {

bool same_rigid_bodies(const RobotPhysics& a, const RobotPhysics& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t j = 0; j < a.size(); ++j) {
    for (const PropertyInfo& info : property_table()) {
      const bool matters =
          is_of_body(info.property) || info.property == Property::sensor_bias || info.property == Property::stiffness;
      if (matters && a[j][info.property] != b[j][info.property]) return false;
    }
  }
  return true;
}

// Through the filter of the torques that are left.
std::vector<JointDerivatives> filtered_derivatives(const Evidence& evidence, std::size_t recording,
                                                   const RobotPhysics& physics,
                                                   const std::vector<JointDerivatives>& rigid) {
  const Motion& motion = evidence.motions[recording];
  std::vector<JointDerivatives> result = torque_derivatives(evidence.robot, motion, physics, evidence.entries, rigid);
  const Eigen::MatrixXd residual = torque_residual(evidence.robot, motion, physics);
  for (std::size_t j = 0; j < result.size(); ++j) {
    const auto c = static_cast<Eigen::Index>(j);
    result[j].by = low_pass(motion.time, motion.low_pass[c], residual.col(c)) * result[j].by;
  }
  return result;
}

// By recording, then joint.
std::vector<std::vector<JointDerivatives>> derivatives_at(const Evidence& evidence, const RobotPhysics& physics,
                                                          const std::vector<StartState>& starts, RigidCache& cache) {
  const bool torque = evidence.robot.setup.drive == DriveKind::torque;
  const std::size_t count = evidence.recordings.size();
  if (torque && !same_rigid_bodies(cache.physics, physics)) {
    cache.by_recording = surefoot::map(
        evidence.threads, count,
        [&](std::size_t r) {
          return rigid_derivatives(evidence.robot, evidence.motions[r], physics, evidence.entries);
        },
        evidence.stop);
    cache.physics = physics;
  }
  return surefoot::map(
      evidence.threads, count,
      [&](std::size_t r) {
        if (torque) return filtered_derivatives(evidence, r, physics, cache.by_recording[r]);
        std::vector<JointDerivatives> result =
            simulation_derivatives(evidence.robot, evidence.recordings[r], starts[r], physics, evidence.entries);
        for (JointDerivatives& one : result) {  // errors: measured less simulated
          one.by = -one.by;
          one.by_start = -one.by_start;
        }
        return result;
      },
      evidence.stop);
}

// Terms that act on a joint.
std::vector<Eigen::Index> terms_of_joint(const Evidence& evidence, std::size_t joint) {
  std::vector<Eigen::Index> result;
  for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
    if (moves(evidence, evidence.terms[t], joint)) result.push_back(static_cast<Eigen::Index>(t));
  }
  return result;
}

// Derivatives of a joint's errors by terms: sums of those by the entries that a term changes.
Eigen::MatrixXd columns_of(const Evidence& evidence, const std::vector<std::vector<JointDerivatives>>& derivatives,
                           std::size_t joint, const std::vector<Eigen::Index>& terms) {
  Eigen::MatrixXd x =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(evidence.block.size()), static_cast<Eigen::Index>(terms.size()));
  Eigen::Index at = 0;
  for (const std::vector<JointDerivatives>& recording : derivatives) {
    if (recording.empty()) break;  // stopped before
    const JointDerivatives& one = recording[joint];
    for (std::size_t e = 0; e < one.entries.size(); ++e) {
      const PhysicsEntry& entry = evidence.entries[one.entries[e]];
      for (std::size_t t = 0; t < terms.size(); ++t) {
        const Term& term = evidence.terms[static_cast<std::size_t>(terms[t])];
        if (term.property == entry.property && std::ranges::find(term.joints, entry.joint) != term.joints.end())
          x.col(static_cast<Eigen::Index>(t)).segment(at, one.by.rows()) += one.by.col(static_cast<Eigen::Index>(e));
      }
    }
    at += one.by.rows();
  }
  return x;
}

// Rows that are not known count nothing, nor do those where a derivative grew beyond reason.
void leave_out_rows(const Evidence& evidence, const std::vector<Eigen::Index>& terms, Eigen::MatrixXd& x,
                    Eigen::VectorXd& r) {
  constexpr double beyond_reason = 1e3;  // [rad] or [N m], of a typical size
  Eigen::RowVectorXd typical(x.cols());
  for (Eigen::Index t = 0; t < x.cols(); ++t)
    typical[t] = evidence.terms[static_cast<std::size_t>(terms[static_cast<std::size_t>(t)])].typical;
  for (Eigen::Index k = 0; k < r.size(); ++k) {
    const double most = x.row(k).cwiseAbs().cwiseProduct(typical).sum();  // not finite if any is not
    if (std::isfinite(r[k]) && most < beyond_reason) continue;
    r[k] = 0;
    x.row(k).setZero();
  }
}

// Sums of one joint by block.
void add_blocks(const Evidence& evidence, const std::vector<Eigen::Index>& terms, const Eigen::MatrixXd& x,
                const Eigen::VectorXd& r, std::vector<Sums>& sums) {
  const auto count = static_cast<Eigen::Index>(evidence.terms.size());
  for (Eigen::Index begin = 0; begin < r.size();) {
    const int block = evidence.block[static_cast<std::size_t>(begin)];
    Eigen::Index end = begin;
    while (end < r.size() && evidence.block[static_cast<std::size_t>(end)] == block) ++end;
    Sums& sum = sums[static_cast<std::size_t>(block)];
    const auto part = x.middleRows(begin, end - begin);
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(x.cols(), x.cols());
    gram.selfadjointView<Eigen::Lower>().rankUpdate(part.transpose());
    gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
    sum.gram = Eigen::MatrixXd::Zero(count, count);
    sum.gram(terms, terms) = gram;
    sum.slope = Eigen::VectorXd::Zero(count);
    sum.slope(terms) = part.transpose() * r.segment(begin, end - begin);
    sum.square = r.segment(begin, end - begin).squaredNorm();
    sum.rows = static_cast<double>(end - begin);
    begin = end;
  }
}

// What a joint's squared errors weigh, as in the linear model.
Eigen::VectorXd weights_of(const LinearModel& model) {
  Eigen::VectorXd square(model.independent.size()), rows = square;
  for (Eigen::Index j = 0; j < square.size(); ++j) {
    const auto joint = static_cast<std::size_t>(j);
    square[j] = model.errors[joint].squaredNorm();
    rows[j] = static_cast<double>(std::max<Eigen::Index>(1, (model.errors[joint].array() != 0).count()));
  }
  return model.independent.cwiseQuotient(rows.cwiseProduct(mean_squares(model, square, rows)));
}

// Derivatives of a joint's errors by the start of one recording, where its rows count.
Eigen::MatrixXd start_columns(const JointDerivatives& derivatives, const Eigen::Ref<const Eigen::VectorXd>& errors) {
  Eigen::MatrixXd by = derivatives.by_start;
  for (Eigen::Index k = 0; k < by.rows(); ++k) {
    if (errors[k] == 0 || !by.row(k).allFinite()) by.row(k).setZero();
  }
  return by;
}

// Columns and errors with starts that follow: by recording and tree.
void let_starts_follow(const Evidence& evidence, const std::vector<std::vector<JointDerivatives>>& derivatives,
                       const std::vector<StartState>& starts, LinearModel& model) {
  const Eigen::VectorXd weight = weights_of(model);
  Eigen::Index first = 0;
  for (std::size_t r = 0; r < derivatives.size() && !derivatives[r].empty(); ++r) {
    const StartState read = start_of(evidence.motions[r]), deviation = start_deviation(evidence, r);
    const Eigen::Index rows = evidence.recordings[r].time.size();
    for (const std::vector<int>& joints : joints_by_tree(evidence.robot)) {
      std::vector<Eigen::MatrixXd> by_start;
      for (const int j : joints) {
        const auto joint = static_cast<std::size_t>(j);
        by_start.push_back(start_columns(derivatives[r][joint], model.errors[joint].segment(first, rows)));
      }
      Eigen::VectorXd size(2 * static_cast<Eigen::Index>(joints.size())), from_read = size;
      size << deviation.angle(joints), deviation.speed(joints);
      from_read << (starts[r].angle - read.angle)(joints), (starts[r].speed - read.speed)(joints);
      StartFit fit = eliminate_start(joints, by_start, size, from_read, weight, first, model.columns, model.errors);
      fit.recording = r;
      fit.terms = model.terms[static_cast<std::size_t>(joints.front())];
      model.starts.push_back(std::move(fit));
    }
    first += rows;
  }
}

}  // namespace

LinearModel linearize(const Evidence& evidence, const Eigen::VectorXd& theta, const std::vector<StartState>& starts,
                      const Eigen::MatrixXd& errors, RigidCache& cache) {
  const std::size_t joints = evidence.robot.joints.size();
  const auto derivatives = derivatives_at(evidence, physics_of(evidence.terms, theta, evidence.base), starts, cache);
  LinearModel model;
  model.theta = theta;
  for (const RobotJoint& joint : evidence.robot.joints) model.pool.push_back(joint.group);
  model.independent.resize(static_cast<Eigen::Index>(joints));
  model.sums.assign(joints, std::vector<Sums>(static_cast<std::size_t>(evidence.blocks)));
  for (std::size_t j = 0; j < joints; ++j) {
    const auto c = static_cast<Eigen::Index>(j);
    model.terms.push_back(terms_of_joint(evidence, j));
    model.columns.push_back(columns_of(evidence, derivatives, j, model.terms[j]));
    model.errors.emplace_back(errors.col(c));
    model.independent[c] = independent_errors(errors.col(c));
    leave_out_rows(evidence, model.terms[j], model.columns[j], model.errors[j]);
  }
  if (evidence.robot.setup.drive != DriveKind::torque) let_starts_follow(evidence, derivatives, starts, model);
  for (std::size_t j = 0; j < joints; ++j) {
    const auto c = static_cast<Eigen::Index>(j);
    Eigen::VectorXd& r = model.errors[j];
    add_blocks(evidence, model.terms[j], model.columns[j], r, model.sums[j]);
    for (Eigen::Index k = 0; k < r.size(); ++k) {
      if (!std::isfinite(errors(k, c))) r[k] = std::nan("");
    }
    model.independent[c] = independent_errors(r);
  }
  add_up(model);
  set_priors(evidence, model);
  TermSet set(evidence.terms.size());
  for (std::size_t t = 0; t < set.size(); ++t) set[t] = theta[static_cast<Eigen::Index>(t)] != 0 ? 1 : 0;
  model.independent = independent_after(model, set);
  set_priors(evidence, model);  // costs follow the independent errors
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

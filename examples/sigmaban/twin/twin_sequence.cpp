#include "twin_sequence.hpp"

#include <Eigen/QR>
#include <array>
#include <cstdio>

#include "surefoot/core/rng.hpp"

namespace sigmaban {

TwinSequence record_sequence(const WalkingTwinOptions& options, const Eigen::Matrix3Xd& commands, std::size_t number,
                             std::uint64_t seed, bool with_joints) {
  TwinSequence result{.number = number, .commands = {}, .moved = {}, .joints = {}};
  WalkingTwin robot(options, surefoot::Rng(seed, number).stream(1));
  for (Eigen::Index cycle = 0; cycle < commands.cols() && !robot.fallen(); ++cycle) {
    const surefoot::Vec<3> command = commands.col(cycle) / steps_per_cycle;
    const surefoot::Pose2 moved = robot.cycle(command, [&](const Twin& twin) {
      if (with_joints) {
        result.joints.push_back({twin.time(), twin.joint_goals(), twin.joint_positions(), twin.joint_currents()});
      }
    });
    if (robot.fallen()) break;
    result.commands.push_back(command);
    result.moved.push_back(moved);
  }
  result.fell = robot.fallen();
  result.simulated = robot.twin().time();
  return result;
}

std::vector<surefoot::Pose2> poses(const TwinSequence& sequence) {
  std::vector<surefoot::Pose2> result;
  surefoot::Pose2 pose;
  for (const surefoot::Pose2& moved : sequence.moved) {
    pose = pose * moved;
    result.push_back(pose);
  }
  return result;
}

surefoot::WalkSequence walk_sequence(const TwinSequence& sequence) {
  const auto cycles = static_cast<Eigen::Index>(sequence.moved.size());
  if (cycles == 0) throw TwinError("sequence " + std::to_string(sequence.number) + " of the twin has no cycle");
  surefoot::WalkSequence result{.name = std::to_string(sequence.number)};
  result.commands.resize(3, cycles);
  result.poses.resize(3, cycles);
  const std::vector<surefoot::Pose2> after = poses(sequence);
  for (Eigen::Index i = 0; i < cycles; ++i) {
    result.commands.col(i) = steps_per_cycle * sequence.commands[static_cast<std::size_t>(i)];
    result.poses.col(i) = after[static_cast<std::size_t>(i)].vec();
  }
  return result;
}

std::string sequences_csv(std::span<const TwinSequence> sequences) {
  std::string text =
      "seq,cycle,order_dx_m,order_dy_m,order_dtheta_rad,moved_x_m,moved_y_m,moved_theta_rad,x_m,y_m,theta_rad\n";
  for (const TwinSequence& sequence : sequences) {
    if (sequence.fell) continue;
    const std::vector<surefoot::Pose2> after = poses(sequence);
    for (std::size_t i = 0; i < after.size(); ++i) {
      const surefoot::Vec<3>& command = sequence.commands[i];
      const surefoot::Pose2 &moved = sequence.moved[i], &pose = after[i];
      text += std::to_string(sequence.number) + ',' + std::to_string(i);
      for (const double value :
           {command[0], command[1], command[2], moved.x, moved.y, moved.angle, pose.x, pose.y, pose.angle}) {
        std::array<char, 40> cell{};
        std::snprintf(cell.data(), cell.size(), ",%.6f", value);
        text += cell.data();
      }
      text += '\n';
    }
  }
  return text;
}

std::string joints_csv(std::span<const TwinSequence> sequences) {
  std::string text = "seq,t_s";
  for (const std::string_view what : {"goal_", "position_", "current_"}) {
    for (const std::string_view joint : joint_names) {
      text += "," + std::string(what) + std::string(joint) + (what == "current_" ? "_A" : "_rad");
    }
  }
  for (const TwinSequence& sequence : sequences) {
    for (const JointRow& row : sequence.joints) {
      std::array<char, 40> cell{};
      std::snprintf(cell.data(), cell.size(), "\n%zu,%.3f", sequence.number, row.time);
      text += cell.data();
      for (const auto* values : {&row.goals, &row.positions, &row.currents}) {
        for (const double value : *values) {
          std::snprintf(cell.data(), cell.size(), ",%.5f", value);
          text += cell.data();
        }
      }
    }
  }
  return text + "\n";
}

Eigen::Matrix<double, 3, 4> walk_gains(std::span<const TwinSequence> sequences) {
  Eigen::Index cycles = 0;
  for (const TwinSequence& sequence : sequences) cycles += static_cast<Eigen::Index>(sequence.moved.size());
  if (cycles < 4) throw TwinError("the gains of a walk need four cycles or more, walk more sequences");
  Eigen::MatrixX4d commanded(cycles, 4);
  Eigen::MatrixX3d moved(cycles, 3);
  Eigen::Index row = 0;
  for (const TwinSequence& sequence : sequences) {
    for (std::size_t i = 0; i < sequence.moved.size(); ++i, ++row) {
      commanded.row(row) << 1, steps_per_cycle * sequence.commands[i].transpose();
      moved.row(row) = sequence.moved[i].vec();
    }
  }
  return commanded.colPivHouseholderQr().solve(moved).transpose();
}

surefoot::Vec<3> gains_residual(std::span<const TwinSequence> sequences, const Eigen::Matrix<double, 3, 4>& gains) {
  surefoot::Vec<3> squares = surefoot::Vec<3>::Zero();
  double cycles = 0;
  for (const TwinSequence& sequence : sequences) {
    for (std::size_t i = 0; i < sequence.moved.size(); ++i, ++cycles) {
      const surefoot::Vec<3> expected =
          gains.leftCols<1>() + gains.rightCols<3>() * (steps_per_cycle * sequence.commands[i]);
      squares += (sequence.moved[i].vec() - expected).cwiseAbs2();
    }
  }
  return (squares / cycles).cwiseSqrt();
}

surefoot::Vec<3> displacement_noise(std::span<const TwinSequence> sequences) {
  constexpr Eigen::Index unknowns = 7;
  Eigen::Index cycles = 0;
  for (const TwinSequence& sequence : sequences) cycles += static_cast<Eigen::Index>(sequence.moved.size());
  if (cycles < unknowns) throw TwinError("the noise of a walk needs seven cycles or more, walk more sequences");
  Eigen::MatrixXd commanded(cycles, unknowns), moved(cycles, 3);
  Eigen::Index row = 0;
  for (const TwinSequence& sequence : sequences) {
    surefoot::Vec<3> before = surefoot::Vec<3>::Zero();
    for (std::size_t i = 0; i < sequence.moved.size(); ++i, ++row) {
      commanded.row(row) << 1, sequence.commands[i].transpose(), before.transpose();
      moved.row(row) = sequence.moved[i].vec();
      before = sequence.commands[i];
    }
  }
  const Eigen::MatrixXd rest = moved - commanded * commanded.colPivHouseholderQr().solve(moved);
  return (rest.colwise().squaredNorm().transpose() / static_cast<double>(cycles)).cwiseSqrt();
}

}  // namespace sigmaban

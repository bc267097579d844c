#include "walk_csv.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace calibrate_program {
namespace {

std::string head(double steps_per_cycle) {
  return "# steps_per_cycle: " + number_text(steps_per_cycle) + "\nseq,cycle,order_dx_m,order_dy_m,order_dtheta_rad";
}

/// To a thousandth of a millimetre, for people who look at the file.
std::string rounded(double value) { return number_text(std::round(1e6 * value) / 1e6); }

std::string command_cells(std::size_t sequence, Eigen::Index cycle, const surefoot::Vec<3>& command,
                          double steps_per_cycle) {
  std::string line = std::to_string(sequence) + "," + std::to_string(cycle);
  for (const double value : command) line += "," + rounded(value / steps_per_cycle);
  return line;
}

}  // namespace

std::string number_text(double value) {
  if (std::isnan(value)) return {};
  std::array<char, 40> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string commands_csv(std::span<const Eigen::Matrix3Xd> commands, double steps_per_cycle) {
  std::string text = head(steps_per_cycle) + "\n";
  for (std::size_t s = 0; s < commands.size(); ++s) {
    for (Eigen::Index cycle = 0; cycle < commands[s].cols(); ++cycle) {
      text += command_cells(s + 1, cycle, commands[s].col(cycle), steps_per_cycle) + "\n";
    }
  }
  return text;
}

std::string walks_csv(std::span<const surefoot::WalkSequence> sequences, double steps_per_cycle) {
  std::string text = head(steps_per_cycle) + ",x_m,y_m,theta_rad\n";
  for (std::size_t s = 0; s < sequences.size(); ++s) {
    for (Eigen::Index cycle = 0; cycle < sequences[s].cycles(); ++cycle) {
      text += command_cells(s + 1, cycle, sequences[s].commands.col(cycle), steps_per_cycle);
      for (const double value : sequences[s].poses.col(cycle)) text += "," + rounded(value);
      text += "\n";
    }
  }
  return text;
}

}  // namespace calibrate_program

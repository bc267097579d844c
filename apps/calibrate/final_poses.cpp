#include "final_poses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include "../common/gnuplot.hpp"

namespace calibrate_program {
namespace {

using Sequences = std::span<const surefoot::WalkSequence>;

/// Measured x, y, and from there to the predicted position, one line per sequence.
std::string block(const surefoot::PreviousCommandCorrection& model, Sequences sequences) {
  std::ostringstream out;
  for (const surefoot::WalkSequence& sequence : sequences) {
    const auto measured = sequence.poses.col(sequence.cycles() - 1);
    const auto predicted = predict_final_pose(model, sequence).position();
    out << measured[0] << ' ' << measured[1] << ' ' << predicted[0] - measured[0] << ' ' << predicted[1] - measured[1]
        << '\n';
  }
  return out.str() + "\n\n";
}

/// Both panels show the same square.
std::string ranges(const surefoot::PreviousCommandCorrection& model, Sequences sequences) {
  surefoot::Vec<2> low = surefoot::Vec<2>::Zero(), high = low;
  for (const surefoot::WalkSequence& sequence : sequences) {
    for (const surefoot::Vec<2>& point :
         {surefoot::Vec<2>(sequence.poses.col(sequence.cycles() - 1).head<2>()),
          predict_final_pose(model, sequence).position(),
          predict_final_pose(surefoot::PreviousCommandCorrection(), sequence).position()}) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  }
  const surefoot::Vec<2> middle = (low + high) / 2;
  const double half = 0.54 * std::max((high - low).maxCoeff(), 0.01);
  std::ostringstream out;
  // Seen from above, looking along x: y grows to the left.
  out << "set xrange [" << middle[1] + half << ":" << middle[1] - half << "]\nset yrange [" << middle[0] - half << ":"
      << middle[0] + half << "]\n";
  return out.str();
}

std::string panel(const std::string& title, double error, int index) {
  char text[200];
  std::snprintf(text, sizeof text, "set title '%s: %.3f m'\n", title.c_str(), error);
  std::ostringstream out;
  out << text << "plot data index " << index
      << " using 2:1:4:3 with vectors nohead lc rgb '#999999' lw 1.2 title 'error', '' index " << index
      << " using ($2+$4):($1+$3) with points pt 6 ps 1 lw 1.4 lc rgb '#d55e00' title 'predicted', '' index " << index
      << " using 2:1 with points pt 7 ps 0.8 lc rgb '#0072b2' title 'measured', '-' using 1:2 with points pt 1 ps 2 "
         "lw 2 lc rgb '#000000' title 'start'\n0 0\ne\n";
  return out.str();
}

}  // namespace

void draw_final_poses(const std::filesystem::path& base, const surefoot::PreviousCommandCorrection& model,
                      Sequences sequences, bool held_out) {
  const surefoot::PreviousCommandCorrection nominal;
  std::string commands = "set multiplot layout 1,2 title 'Final positions of " + std::to_string(sequences.size()) +
                         (held_out ? " held-out sequences" : " sequences, fitted to") +
                         " (root mean square error above)'\n"
                         "set size ratio -1\nset grid lc rgb '#e6e6e6' lt 1\n"
                         "set key below\nset xlabel 'left of the start [m]'\nset ylabel 'ahead of it [m]'\n" +
                         ranges(model, sequences);
  commands += panel("commands as they are", final_pose_error(nominal, sequences).position, 0);
  commands += panel("corrected", final_pose_error(model, sequences).position, 1);
  example::draw(base, commands + "unset multiplot\n", block(nominal, sequences) + block(model, sequences), 1100, 640);
}

}  // namespace calibrate_program

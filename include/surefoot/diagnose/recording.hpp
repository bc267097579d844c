// One recording of a machine: what was ordered, what was measured, and what was constant meanwhile.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "surefoot/core/error.hpp"

namespace surefoot {

/// What an input is between rows: the value of a row until the next one (zero-order hold: a command that is logged as
/// it is given), a straight line between both (first-order hold: something smooth that was measured), the value of a
/// row since the one before (a command that is logged after it acted), or a smooth curve (a band-limited signal that
/// was measured, by the cubic spline through its rows).
enum class InputHold : std::uint8_t { zero_order, linear, before, band_limited };

/// As model files call it.
constexpr std::string_view hold_name(InputHold hold) {
  switch (hold) {
    case InputHold::linear:
      return "linear";
    case InputHold::before:
      return "before";
    case InputHold::band_limited:
      return "band-limited";
    case InputHold::zero_order:
      break;
  }
  return "held";
}

/// One column per row of the recording (a context for an ODE, a step for a map). Units are those of the model.
struct Recording {
  std::string name;                         // for messages and reports: the file's name
  std::map<std::string, double> constants;  // of this recording: mass, gain, supply voltage, ...
  Eigen::VectorXd time;                     // [s] rising; for a map the number of the row
  Eigen::MatrixXd inputs;                   // input x row; between rows as InputInfo::hold says
  Eigen::MatrixXd outputs;                  // output x row; NaN: not measured in that row
  Eigen::VectorXd initial;                  // state in the first row, as far as it is known
  Eigen::VectorXd initial_scale;  // 0: that state is known; else it is estimated, and may be off by about this

  Eigen::Index rows() const { return time.size(); }
  double duration() const { return rows() > 1 ? time[rows() - 1] - time[0] : 0; }  // [s], or steps
};

/// Rows [from, to) of a recording as one of its own. Its initial state is unknown unless it starts in row 0: it is
/// estimated, from `initial` on, off by about `scale`.
Recording part_of(const Recording& whole, Eigen::Index from, Eigen::Index to, const Eigen::VectorXd& initial,
                  const Eigen::VectorXd& scale);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/recording.ipp"
#endif

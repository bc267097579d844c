// The inputs of a recording as functions of time: held or interpolated between rows, each possibly late.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/simulation/cubic_spline.hpp"
#include "surefoot/diagnose/simulation/small_vectors.hpp"
#include "surefoot/diagnose/simulator.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

template <class Input>
class InputSignal {
 public:
  /// `holds`: of those inputs of which the model does not say; empty: held.
  InputSignal(const SimulatorInfo& info, const Recording& recording, const std::vector<InputHold>& holds = {})
      : recording_(recording),
        late_(info.inputs.size(), 0.0),
        ahead_(info.inputs.size(), 0),
        interpolated_(info.inputs.size()),
        bends_(info.inputs.size()),
        from_rest_(info.inputs.size(), false),
        seen_(info.inputs.size(), 0) {
    for (std::size_t i = 0; i < interpolated_.size(); ++i) {
      const InputHold hold = hold_of(info, holds, i);
      const bool bends = hold == InputHold::band_limited;
      interpolated_[i] = bends || hold == InputHold::linear;
      if (bends) {
        bends_[i] = second_derivatives(recording.time,
                                       surefoot::detail::row_of(recording.inputs, static_cast<Eigen::Index>(i)));
      }
      ahead_[i] = hold == InputHold::before ? 1 : 0;
      any_special_ = any_special_ || interpolated_[i];
      steady_ = steady_ && !interpolated_[i];
    }
    held_ = at_row(0);
  }

  /// Makes input i come later by `delay` [s, or steps]; delays of one input add up. Before the first row it was as in
  /// that row or, `from_rest`, 0.
  void delay(int i, double delay, bool from_rest = false) {
    late_[static_cast<std::size_t>(i)] += delay;
    if (from_rest) from_rest_[static_cast<std::size_t>(i)] = true;
    any_special_ = true;
    integral_.resize(late_.size());
    auto& sum = integral_[static_cast<std::size_t>(i)];
    if (!sum.empty() || interpolated_[static_cast<std::size_t>(i)]) return;
    sum.assign(static_cast<std::size_t>(recording_.rows()), 0.0);
    for (std::size_t row = 1; row < sum.size(); ++row) {
      const auto r = static_cast<Eigen::Index>(row);
      sum[row] = sum[row - 1] + logged(i, r - 1) * (recording_.time[r] - recording_.time[r - 1]);
    }
  }

  Input at_row(Eigen::Index row) const {
    Input u = unset<Input>(recording_.inputs.rows());
    for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = logged(i, row);
    return u;
  }

  void go_to(Eigen::Index row) {
    held_ = at_row(row);
    if (!any_special_) return;
    for (std::size_t i = 0; i < seen_.size(); ++i) seen_[i] = row_before(i, recording_.time[row] - late_[i]);
  }

  /// The first time after t, if before `end`, at which a held input that comes late changes; else `end`. Steps that end
  /// there see constant inputs, and what they lead to is a smooth function of the delay.
  double next_change(double t, double end) const {
    const double after = t + 1e-9 * (end - t);  // what is rounded to t has been
    double next = end;
    for (std::size_t i = 0; i < late_.size(); ++i) {
      if (late_[i] == 0 || interpolated_[i]) continue;
      const auto k = static_cast<Eigen::Index>(i);
      const double begin = recording_.time[0] + late_[i];
      if (from_rest_[i] && begin > after && logged(k, 0) != 0) next = std::min(next, begin);
      for (Eigen::Index row = row_before(i, after - late_[i]) + 1; row < recording_.rows(); ++row) {
        const double change = recording_.time[row] + late_[i];
        if (change >= next) break;
        if (change > after && logged(k, row) != logged(k, row - 1)) next = change;
      }
    }
    return next;
  }

  /// Whether any held input comes late.
  bool late() const { return !integral_.empty(); }

  /// The inputs of that row as they stand in the recording.
  const Input& now() const { return held_; }

  /// Whether inputs stay the same during a step: none is interpolated.
  bool steady() const { return steady_; }

  /// The inputs at the share `share` of a step of length h from time t on, within the row that go_to named.
  Input between(double t, double h, double share) const { return any_special_ ? moving(t, h, share) : held_; }

 private:
  Input moving(double t, double h, double share) const {
    Input u = held_;
    for (std::size_t i = 0; i < late_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (interpolated_[i]) {
        u[k] = interpolated(k, t + share * h - late_[i]);
      } else if (late_[i] != 0) {
        u[k] = (integral(i, t + h - late_[i]) - integral(i, t - late_[i])) / h;
      }
    }
    return u;
  }

  // What is given from a row on.
  double logged(Eigen::Index i, Eigen::Index row) const {
    return recording_.inputs(i, std::min(row + ahead_[static_cast<std::size_t>(i)], recording_.rows() - 1));
  }

  // The last row at or before time t, or the first; rows are searched from the one that input i showed last.
  Eigen::Index row_before(std::size_t i, double t) const {
    Eigen::Index row = seen_[i];
    while (row > 0 && recording_.time[row] > t) --row;
    while (row + 1 < recording_.rows() && recording_.time[row + 1] <= t) ++row;
    return row;
  }

  double interpolated(Eigen::Index i, double t) const {
    const Eigen::Index row = row_before(static_cast<std::size_t>(i), t);
    if (rests(static_cast<std::size_t>(i), t)) return 0;
    if (t <= recording_.time[0]) return recording_.inputs(i, 0);
    if (row + 1 >= recording_.rows()) return recording_.inputs(i, row);
    const double interval = recording_.time[row + 1] - recording_.time[row];
    const double share = (t - recording_.time[row]) / interval;
    const double straight =
        recording_.inputs(i, row) + share * (recording_.inputs(i, row + 1) - recording_.inputs(i, row));
    const std::vector<double>& bends = bends_[static_cast<std::size_t>(i)];
    if (bends.empty()) return straight;
    const auto r = static_cast<std::size_t>(row);
    return straight + bend_between(bends[r], bends[r + 1], interval, share);
  }

  bool rests(std::size_t i, double t) const { return from_rest_[i] && t < recording_.time[0]; }

  // Integral of a held input from the first row on; before it the first value counts, or 0.
  double integral(std::size_t i, double t) const {
    if (rests(i, t)) return 0;
    const auto k = static_cast<Eigen::Index>(i);
    const Eigen::Index row = row_before(i, t);
    return integral_[i][static_cast<std::size_t>(row)] + logged(k, row) * (t - recording_.time[row]);
  }

  const Recording& recording_;
  std::vector<double> late_;
  std::vector<Eigen::Index> ahead_;  // by input: the row that holds what is given from a row on, relative to it
  std::vector<bool> interpolated_;
  std::vector<std::vector<double>> bends_;  // by input: second derivatives at rows; empty: straight between them
  std::vector<bool> from_rest_;
  std::vector<std::vector<double>> integral_;
  std::vector<Eigen::Index> seen_;  // by input: the row it showed at the beginning of the present one
  Input held_;
  bool any_special_ = false, steady_ = true;
};

}  // namespace surefoot::diagnosis

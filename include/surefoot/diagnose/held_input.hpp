// The inputs of a recording as functions of time: held or interpolated between rows, each possibly late.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/simulator.hpp"

namespace surefoot::detail {

template <class Input>
class HeldInput {
 public:
  HeldInput(const SimulatorInfo& info, const Recording& recording)
      : recording_(recording), late_(info.inputs.size(), 0.0), linear_(info.inputs.size()) {
    for (std::size_t i = 0; i < linear_.size(); ++i) {
      linear_[i] = info.inputs[i].linear;
      any_special_ = any_special_ || linear_[i];
    }
    held_ = at_row(0);
  }

  /// Makes input i come later by `delay` [s, or steps]; delays of one input add up.
  void delay(int i, double delay) {
    late_[static_cast<std::size_t>(i)] += delay;
    any_special_ = true;
    integral_.resize(late_.size());
    auto& sum = integral_[static_cast<std::size_t>(i)];
    if (!sum.empty() || linear_[static_cast<std::size_t>(i)]) return;
    sum.assign(static_cast<std::size_t>(recording_.rows()), 0.0);
    for (std::size_t row = 1; row < sum.size(); ++row) {
      const auto r = static_cast<Eigen::Index>(row);
      sum[row] = sum[row - 1] + recording_.inputs(i, r - 1) * (recording_.time[r] - recording_.time[r - 1]);
    }
  }

  Input at_row(Eigen::Index row) const {
    Input u = [&] {
      if constexpr (Input::RowsAtCompileTime == Eigen::Dynamic) {
        return Input(recording_.inputs.rows());
      } else {
        return Input();
      }
    }();
    for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = recording_.inputs(i, row);
    return u;
  }

  void go_to(Eigen::Index row) {
    row_ = row;
    held_ = at_row(row);
  }

  /// The inputs at the share `share` of a step of length h from time t on, within the row that go_to named.
  Input between(double t, double h, double share) const {
    if (!any_special_) return held_;
    Input u = held_;
    for (std::size_t i = 0; i < late_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (linear_[i]) {
        u[k] = interpolated(k, t + share * h - late_[i]);
      } else if (late_[i] != 0) {
        u[k] = (integral(i, t + h - late_[i]) - integral(i, t - late_[i])) / h;
      }
    }
    return u;
  }

 private:
  // The last row at or before time t; rows are searched back from the present one.
  Eigen::Index row_before(double t) const {
    Eigen::Index row = row_;
    while (row > 0 && recording_.time[row] > t) --row;
    while (row + 1 < recording_.rows() && recording_.time[row + 1] <= t) ++row;
    return row;
  }

  double interpolated(Eigen::Index i, double t) const {
    const Eigen::Index row = row_before(t);
    if (t <= recording_.time[0]) return recording_.inputs(i, 0);
    if (row + 1 >= recording_.rows()) return recording_.inputs(i, row);
    const double share = (t - recording_.time[row]) / (recording_.time[row + 1] - recording_.time[row]);
    return recording_.inputs(i, row) + share * (recording_.inputs(i, row + 1) - recording_.inputs(i, row));
  }

  // Integral of a held input from the first row on; before it the first value counts.
  double integral(std::size_t i, double t) const {
    const auto k = static_cast<Eigen::Index>(i);
    const Eigen::Index row = row_before(t);
    return integral_[i][static_cast<std::size_t>(row)] + recording_.inputs(k, row) * (t - recording_.time[row]);
  }

  const Recording& recording_;
  std::vector<double> late_;
  std::vector<bool> linear_;
  std::vector<std::vector<double>> integral_;
  Eigen::Index row_ = 0;
  Input held_;
  bool any_special_ = false;
};

}  // namespace surefoot::detail

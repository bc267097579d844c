// Simulation of a machine with one degree of freedom and any faults: classical Runge-Kutta, with bristles, plays and
// stops brought up to date once per step.
#pragma once

#include <array>
#include <vector>

#include "force_faults.hpp"
#include "signal_faults.hpp"

namespace plants {

/// Starts of the integration steps and the orders held in them, after all faults on the way.
struct FineGrid {
  Column times, order;
};

inline FineGrid fine_grid(const Recording& recording, std::size_t input, const std::vector<Fault>& faults,
                          int substeps) {
  FineGrid grid;
  for (std::size_t row = 0; row + 1 < recording.time.size(); ++row) {
    const double step = (recording.time[row + 1] - recording.time[row]) / substeps;
    for (int k = 0; k < substeps; ++k) {
      grid.times.push_back(recording.time[row] + k * step);
      grid.order.push_back(recording.inputs[input][row]);
    }
  }
  for (const Fault& fault : faults)
    if (fault.place == Place::input && fault.target == static_cast<int>(input)) {
      change_order(fault, grid.times, grid.order);
    }
  return grid;
}

/// A Machine is made from parameters and a recording and offers signal(order, position), drive(signal, speed),
/// load(position, speed), inertia and motor_inertia (the part of it before a gear's play).
template <class Machine>
class OneDofRun {
 public:
  OneDofRun(const Values& parameters, const std::vector<Fault>& faults, const Recording& recording, const How& how)
      : parameters_(parameters),
        faults_(faults),
        recording_(recording),
        how_(how),
        machine_(parameters, recording),
        held_(faults.size(), 0.0),
        y_(2 + 2 * faults.size(), 0.0) {}

  Series run(bool speed_output) {
    const FineGrid grid = fine_grid(recording_, 0, faults_, how_.substeps);
    start(grid);
    Series series{{{y_[0]}, {y_[1]}}, {}};
    const auto substeps = static_cast<std::size_t>(how_.substeps);
    for (std::size_t i = 0; i < grid.times.size(); ++i) {
      const std::size_t row = i / substeps;
      advance(grid.times[i], (recording_.time[row + 1] - recording_.time[row]) / how_.substeps, grid.order[i]);
      if ((i + 1) % substeps != 0) continue;
      series.states[0].push_back(y_[0]);
      series.states[1].push_back(y_[1]);
    }
    series.outputs.push_back(series.states[0]);
    if (speed_output) series.outputs.push_back(series.states[1]);
    for (const Fault& fault : faults_)
      if (fault.place == Place::sensor) {
        change_readings(fault, recording_.time, series.outputs[static_cast<std::size_t>(fault.target)]);
      }
    return series;
  }

 private:
  void start(const FineGrid& grid) {
    y_[0] = how_.from_readings ? recording_.readings[0][0] : recording_.initial[0];
    y_[1] = recording_.initial[1];
    for (std::size_t k = 0; k < faults_.size(); ++k) {
      const Formula formula = faults_[k].formula;
      if (formula == Formula::elasticity || formula == Formula::two_mass_play) y_[2 + 2 * k] = y_[0];
      if (formula == Formula::play_seen) held_[k] = y_[0];
      if (is_signal_lag(faults_[k])) y_[2 + 2 * k] = machine_.signal(grid.order[0], y_[0]);
      drifting_ |= faults_[k].place == Place::parameter;
    }
  }

  static bool is_signal_lag(const Fault& fault) {
    return fault.place == Place::signal && fault.formula == Formula::lag;
  }

  void advance(double time, double step, double order) {
    if (drifting_) drift(time);
    const std::vector<double> start = y_;
    std::vector<double>&k1 = slopes_[0], &k2 = slopes_[1], &k3 = slopes_[2], &k4 = slopes_[3];
    const auto stage = [&](const std::vector<double>& slope, double share) {
      for (std::size_t i = 0; i < y_.size(); ++i) y_[i] = start[i] + share * step * slope[i];
    };
    rates(time, order, k1);
    stage(k1, 0.5);
    rates(time + step / 2, order, k2);
    stage(k2, 0.5);
    rates(time + step / 2, order, k3);
    stage(k3, 1);
    rates(time + step, order, k4);
    for (std::size_t i = 0; i < y_.size(); ++i) y_[i] = start[i] + step / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    settle(time + step, step, order);
  }

  void drift(double time) {
    Values now = parameters_;
    for (const Fault& fault : faults_)
      if (fault.place == Place::parameter)
        now[static_cast<std::size_t>(fault.target)] *= factor_of_parameter(fault, time);
    machine_ = Machine(now, recording_);
  }

  // The order as it reaches the drive.
  double arriving_signal(double order, double position) const {
    double signal = machine_.signal(order, position);
    for (std::size_t k = 0; k < faults_.size(); ++k) {
      if (faults_[k].place != Place::signal) continue;
      signal =
          is_signal_lag(faults_[k]) ? y_[2 + 2 * k] : static_signal(faults_[k], signal, machine_.work(signal, y_[1]));
    }
    return signal;
  }

  double seen_position() const {
    double position = y_[0];
    for (std::size_t k = 0; k < faults_.size(); ++k)
      if (faults_[k].formula == Formula::play_seen) position = play(y_[0], held_[k], faults_[k].a);
    return position;
  }

  Motion motion(double time, double order) const {
    const double seen = seen_position();
    Motion at{time, y_[0], y_[1], 0, machine_.load(seen, y_[1]), machine_.inertia};
    at.drive = machine_.drive(arriving_signal(order, seen), y_[1]);
    for (const Fault& fault : faults_)
      if (fault.formula == Formula::changing_mass) {
        at.inertia *= 1 + fault.a / (1 + std::exp(-(std::abs(y_[0]) - fault.b) / fault.c));
      }
    return at;
  }

  void rates(double time, double order, std::vector<double>& slope) {
    slope.assign(y_.size(), 0.0);
    Motion at = motion(time, order);
    double force = at.load;
    bool geared = false;
    for (std::size_t k = 0; k < faults_.size(); ++k) {
      const std::size_t own = 2 + 2 * k;
      if (is_signal_lag(faults_[k])) {
        slope[own] = (machine_.signal(order, seen_position()) - y_[own]) / faults_[k].a;
      } else if (faults_[k].formula == Formula::two_mass_play) {
        force += motor_side(faults_[k], order, own, slope);
        at.inertia -= machine_.motor_inertia;
        geared = true;
      } else if (faults_[k].place == Place::force) {
        Hidden change;
        force += fault_force(faults_[k], at, {y_[own], y_[own + 1], held_[k]}, change);
        slope[own] = change.first;
        slope[own + 1] = change.second;
      }
    }
    slope[0] = y_[1];
    slope[1] = (force + (geared ? 0 : at.drive)) / at.inertia;
  }

  // The motor before a gear with play: position and speed in y_[own], y_[own + 1]. Returns the force it passes on.
  double motor_side(const Fault& fault, double order, std::size_t own, std::vector<double>& slope) const {
    const double twist = y_[own] - y_[0];
    const double depth = twist - std::clamp(twist, -fault.a, fault.a);
    const double frequency = 2 * std::numbers::pi * 35;  // of the motor on the teeth [rad/s]
    const double inertia = machine_.motor_inertia;
    const double damping = depth == 0 ? 0 : inertia * frequency * (y_[own + 1] - y_[1]);
    const double contact = inertia * frequency * frequency * depth + damping;
    slope[own] = y_[own + 1];
    slope[own + 1] = (machine_.drive(arriving_signal(order, y_[0]), y_[own + 1]) - contact) / inertia;
    return contact;
  }

  void settle(double time, double step, double order) {
    for (std::size_t k = 0; k < faults_.size(); ++k) {
      const Fault& fault = faults_[k];
      if (is_dry(fault) && fault.place == Place::force) {
        held_[k] = next_deflection(fault, motion(time, order), held_[k], step);
      } else if (fault.formula == Formula::play_seen) {
        held_[k] = play(y_[0], held_[k], fault.a);
      } else if (fault.formula == Formula::stop_hard && (y_[0] - fault.a) * fault.b > 0) {
        y_[0] = fault.a;
        if (y_[1] * fault.b > 0) y_[1] *= -fault.c;
      }
    }
  }

  const Values& parameters_;
  const std::vector<Fault>& faults_;
  const Recording& recording_;
  How how_;
  Machine machine_;
  std::vector<double> held_, y_;  // y_: position, speed, then two hidden states per fault
  std::array<std::vector<double>, 4> slopes_;
  bool drifting_ = false;
};

}  // namespace plants

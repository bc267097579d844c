// Simulation of a recording with a simulator and any effects attached to it.
//
// ODEs: Runge-Kutta of order 4 or 2 (midpoint) between rows, one or more steps each. Dry friction is neither smoothed
// nor stiff: within a step each velocity either slides in one direction or sticks (its force is then the one that holds
// it), and a step in which it would reverse is cut where it stops. Steps are also cut where an end stop is hit and
// where a late input changes, so that the result is a smooth function of level and delay. Maps: one step per row. Cost:
// rows * steps * stages evaluations.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/simulation/integrate.hpp"
#include "surefoot/diagnose/simulation/step_updates.hpp"

namespace surefoot::diagnosis {

/// One simulation under way; `s` must be prepared for the recording.
template <Simulator S>
class SimulationRun {
  using State = typename S::State;
  using Input = typename S::Input;

 public:
  SimulationRun(S& s, const SimulatorInfo& info, const SimulatorStructure& structure, const Sizes& sizes,
                const Recording& recording, const Eigen::VectorXd& p, const Augmentation& augmentation,
                const Integration& integration)
      : info_(info),
        recording_(recording),
        integration_(integration),
        nominal_(p),
        m_{.simulator = s,
           .structure = structure,
           .p = p,
           .slots = assign_slots(augmentation, info, structure, sizes),
           .start = recording.time[0],
           .raw = std::vector<double>(augmentation.effects.size()),
           .past = std::vector<SignalHistory>(augmentation.effects.size())},
        u_(info, recording, integration.inputs),
        modes_(m_.slots.dry.size()) {
    m_.driven_signals = has_tap<S> && std::any_of(structure.driven_signal.begin(), structure.driven_signal.end(),
                                                  [](bool driven) { return driven; });
    for (const EffectSlot& slot : m_.slots.delays)
      u_.delay(slot.at, slot.effect->delay(slot.p), slot.effect->from_rest);
    prepare(m_.simulator, m_.p);
  }

  SimulatedRun run(const Eigen::VectorXd& initial) {
    const Eigen::Index rows = recording_.rows(), n = initial.size();
    SimulatedRun result{Eigen::MatrixXd(static_cast<Eigen::Index>(info_.outputs.size()), rows),
                        Eigen::MatrixXd(n, rows)};
    Point<S> now{converted<State>(initial), Hidden::Zero(m_.slots.hidden)};
    if (!m_.slots.sensors.empty()) undo_sensors(now.x);
    if (m_.slots.hidden > 0) start(now);
    for (Eigen::Index row = 0;; ++row) {
      write(now.x, result.states, row);
      write(observe(now, row), result.outputs, row);
      if (!all_finite(now.x)) {
        result.finite = false;
        return result;
      }
      if (row + 1 == rows) break;
      if (integration_.restart > 0 && row > 0 && row % integration_.restart == 0) restart(now, row);
      if (integration_.follow > 0 && row > 0) follow(now, result.outputs, row);
      if (!m_.slots.drifts.empty()) drift(row);
      advance_row(now, row);
    }
    for (const EffectSlot& slot : m_.slots.sensors) {
      std::vector<double> readings;
      for (Eigen::Index row = 0; row < rows; ++row) readings.push_back(result.outputs(slot.at, row));
      slot.effect->sensor({{recording_.time.data(), static_cast<std::size_t>(rows)}, readings}, slot.p);
      for (Eigen::Index row = 0; row < rows; ++row) {
        result.outputs(slot.at, row) = readings[static_cast<std::size_t>(row)];
      }
    }
    result.finite = surefoot::all_finite(result.outputs);
    return result;
  }

  /// Force on each state (rate * effort), and each signal, at a point without effects: for sizes.
  void probe(const State& x, Eigen::Index row, Eigen::VectorXd& efforts, std::vector<double>& signals) {
    const Input u = u_.at_row(row);
    signals.resize(info_.signals.size());
    const State f = evaluate(m_.simulator, x, u, m_.p, [&](int i, double value) {
      signals[static_cast<std::size_t>(i)] = value;
      return value;
    });
    efforts = converted<Eigen::VectorXd>(f);
    if constexpr (is_ode<S>) {
      const ForceResponse<S> response = force_response(m_, x, u);
      for (Eigen::Index i = 0; i < efforts.size(); ++i) efforts[i] = force_on(m_, response, static_cast<int>(i), f);
    }
  }

 private:
  /// What outputs show in a row, with the effects on inputs and signals.
  typename S::Output observe(const Point<S>& at, Eigen::Index row) {
    const EffectSlots& slots = m_.slots;
    u_.go_to(row);
    if (slots.commands.empty() && slots.taps.empty() && slots.delays.empty()) {
      return m_.simulator.observe(at.x, u_.now(), m_.p);
    }
    const double t = recording_.time[row];
    const double h = row + 1 < recording_.rows() ? recording_.time[row + 1] - t : t - recording_.time[row - 1];
    Hidden dz = Hidden::Zero(slots.hidden);
    Input u = u_.between(t, h, 0);
    for (const EffectSlot& slot : slots.commands) u[slot.at] = through(m_, slot, u[slot.at], at.z, dz, t, h);
    if constexpr (requires { m_.simulator.observe(at.x, u, m_.p, NoTap{}); }) {
      if (!slots.taps.empty()) return m_.simulator.observe(at.x, u, m_.p, tap_of(m_, at.z, dz, t, h));
    }
    return m_.simulator.observe(at.x, u, m_.p);
  }

  /// From a row, to which inputs went already, to the next one.
  void advance_row(Point<S>& now, Eigen::Index row) {
    const double from = recording_.time[row], length = row_length(recording_.time[row + 1] - from);
    if constexpr (is_ode<S>) {
      const int steps = steps_in(length);
      const double h = length / steps;
      for (int i = 0; i < steps; ++i) {
        double t = from + i * h;
        if (u_.late()) {
          const double end = from + (i + 1) * h;
          for (double next = u_.next_change(t, end); next < end; next = u_.next_change(t, end)) {
            advance(now, t, next - t);
            t = next;
          }
          advance(now, t, end - t);
        } else {
          advance(now, t, h);
        }
      }
    } else {
      next_values(m_, u_.between(from, 1, 0), now, from, info_.planar);
      apply_step_updates(m_, now, u_.now(), from, 1);
    }
  }

  /// Equal times between rows differ in their last digits; what effects keep for a step serves the next one if they do
  /// not.
  static double row_length(double length) {
    constexpr double unit = 0x1p-40;  // [s], below any clock's resolution
    const double rounded = std::round(length / unit) * unit;
    return rounded > 0 ? rounded : length;
  }

  void advance(Point<S>& now, double t, double h, int hits = 0) {
    if (m_.slots.limits.empty()) return advance_through(now, t, h);
    const Point<S> before = now;
    step(m_, u_, integration_.order, now, t, h, modes_);
    constexpr int most_hits = 4;  // in a step; what bounces more often rests
    const StopHit hit = hits < most_hits ? first_hit(m_.slots, before, now) : StopHit{};
    if (!(hit.beyond > 0 && hit.beyond < h)) return apply_step_updates(m_, now, u_.now(), t, h);
    double length = h - hit.beyond;
    for (int round = 0; round < 3; ++round) {  // of Newton's method, which doubles the right digits in each
      assign(now, before);
      step(m_, u_, integration_.order, now, t, length, modes_);
      const double later = hit.until(now.x);
      if (round == 2 || !(std::abs(later) > 1e-12 * h)) break;
      length = std::clamp(length + later, 0.0, h);
    }
    now.x[hit.position] = std::nextafter(hit.level, hit.level + now.x[hit.velocity]);  // so that the limit acts
    apply_step_updates(m_, now, u_.now(), t, length);
    advance(now, t + length, h - length, hits + 1);
  }

  void advance_through(Point<S>& now, double t, double h) {
    step(m_, u_, integration_.order, now, t, h, modes_);
    apply_step_updates(m_, now, u_.now(), t, h);
  }

  int steps_in(double length) const {
    if (!(integration_.step > 0) || length <= integration_.step) return 1;
    return std::max(1, static_cast<int>(std::ceil(length / integration_.step - 1e-6)));
  }

  void start(Point<S>& now) {
    u_.go_to(0);
    const double t = recording_.time[0];
    const std::vector<Mode> sliding(modes_.size(), Mode::forth);
    Hidden dz = Hidden::Zero(m_.slots.hidden);
    rates(m_, now.x, now.z, u_.between(t, 1e-9, 0), dz, t, 1e-9, sliding);  // so that effects have seen a first value
    for (const EffectSlot& slot : m_.slots.updates) {
      if (slot.effect->start) slot.effect->start(update_context(m_, slot, now, t, 0), slot.p, slot.hidden(now.z));
      if (slot.start == 0) continue;
      slot.hidden(now.z)[0] += slot.start;
      if (slot.effect->limit_start) slot.effect->limit_start(slot.p, slot.hidden(now.z));
    }
  }

  /// By how much the readings of an output change over some time from the first row on; 0 where they are missing.
  double moved_within(int output, double length) const {
    Eigen::Index after = 1;
    while (after + 1 < recording_.rows() && recording_.time[after] - recording_.time[0] < length) ++after;
    const double from = recording_.time[after - 1] - recording_.time[0],
                 to = recording_.time[after] - recording_.time[0];
    const double a = recording_.outputs(output, after - 1), b = recording_.outputs(output, after);
    const double share = std::clamp((length - from) / (to - from), 0.0, 1.0);
    const bool angle = info_.outputs[static_cast<std::size_t>(output)].unit == "rad";
    const auto difference = [angle](double d) { return angle ? wrap_angle(d) : d; };
    const double moved = difference(a - recording_.outputs(output, 0)) + share * difference(b - a);
    return std::isfinite(moved) ? moved : 0;
  }

  /// An initial state that was read off a sensor has the fault of that sensor, which is taken out again.
  void undo_sensors(State& x) const {
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const auto state = static_cast<Eigen::Index>(i);
      const int output = m_.structure.output_of[i];
      if (output < 0) continue;
      const StateReading way = reading_of(m_.structure, i);
      if (recording_.initial[state] != way.state_at(recording_.outputs(output, 0))) continue;
      for (const EffectSlot& slot : m_.slots.sensors) {
        if (slot.at != output || !slot.effect->delay) continue;
        x[state] += moved_within(output, slot.effect->delay(slot.p)) / way.slope;
      }
      const double read = way.reading_at(x[state]), time = 0;
      for (int round = 0; round < 3; ++round) {
        double reading = way.reading_at(x[state]);
        for (const EffectSlot& slot : m_.slots.sensors) {
          if (slot.at == output && slot.effect->at_start) slot.effect->sensor({{&time, 1}, {&reading, 1}}, slot.p);
        }
        x[state] += (read - reading) / way.slope;
      }
    }
  }

  void restart(Point<S>& now, Eigen::Index row) const {
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const int output = m_.structure.output_of[i];
      if (output < 0) continue;
      const double measured = recording_.outputs(output, row);
      if (std::isfinite(measured)) now.x[static_cast<Eigen::Index>(i)] = reading_of(m_.structure, i).state_at(measured);
    }
  }

  /// Moves measured states towards their readings, and unmeasured speeds of measured states with them: an alpha-beta
  /// tracker (T. R. Benedict, G. W. Bordner, IRE Trans. Automatic Control 7, 1962), which forgets within 1 / follow
  /// rows.
  void follow(Point<S>& now, const Eigen::MatrixXd& outputs, Eigen::Index row) const {
    const double alpha = integration_.follow, beta = alpha * alpha / (2 - alpha);
    const double interval = is_ode<S> ? recording_.time[row] - recording_.time[row - 1] : 1;
    const auto off = [&](int state) {  // NaN where it is not measured
      const int output = state < 0 ? -1 : m_.structure.output_of[static_cast<std::size_t>(state)];
      if (output < 0) return std::numeric_limits<double>::quiet_NaN();
      const double distance = recording_.outputs(output, row) - outputs(output, row);
      const double slope = reading_of(m_.structure, static_cast<std::size_t>(state)).slope;
      return (info_.outputs[static_cast<std::size_t>(output)].unit == "rad" ? wrap_angle(distance) : distance) / slope;
    };
    for (int i = 0; i < static_cast<int>(info_.states.size()); ++i) {
      const double own = off(i), of_position = off(m_.structure.position_of[static_cast<std::size_t>(i)]);
      if (std::isfinite(own)) {
        now.x[i] += alpha * own;
      } else if (std::isfinite(of_position)) {
        now.x[i] += beta / interval * of_position;
      }
    }
  }

  void drift(Eigen::Index row) {
    m_.p = nominal_;
    for (const EffectSlot& slot : m_.slots.drifts) {
      m_.p[slot.at] *= slot.effect->factor({.time = recording_.time[row] - recording_.time[0]}, slot.p);
    }
    prepare(m_.simulator, m_.p);
  }

  const SimulatorInfo& info_;
  const Recording& recording_;
  Integration integration_;
  Eigen::VectorXd nominal_;
  AugmentedSimulator<S> m_;
  InputSignal<Input> u_;
  std::vector<Mode> modes_;
};

}  // namespace surefoot::diagnosis

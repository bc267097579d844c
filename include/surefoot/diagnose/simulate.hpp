// Simulates a recording with a simulator and any effects attached to it.
//
// ODEs: Runge-Kutta of order 4 or 2 (midpoint) between rows, one or more steps each. Dry friction is neither smoothed
// nor stiff: within a step each velocity either slides in one direction or sticks (its force is then the one that holds
// it), and a step in which it would reverse is cut where it stops. Inputs that come late are averaged over the step, so
// that the result is a smooth function of the delay. Maps: one step per row. Cost: rows * steps * stages evaluations.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/diagnose/effect.hpp"
#include "surefoot/diagnose/facts.hpp"
#include "surefoot/diagnose/held_input.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace surefoot {

struct Integration {
  int order = 4;    // 4, or 2
  double step = 0;  // longest step [s]; 0: one step per row
  int restart = 0;  // begin again from the measured state every so many rows; 0: never (all states must be measured)
};

/// What was simulated, before each restart.
struct SimulatedRun {
  Eigen::MatrixXd outputs;  // output x row
  Eigen::MatrixXd states;   // state x row
  bool finite = true;
};

/// Effects with the values of their parameters.
struct Augmentation {
  std::span<const AttachedEffect> effects;
  std::span<const Eigen::VectorXd> values;  // one vector per effect, in units of the model
};

namespace detail {

/// One simulation under way; `s` must be prepared for the recording.
template <Simulator S>
class SimulationRun {
  using State = typename S::State;
  using Input = typename S::Input;
  using Hidden = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 24, 1>;

  struct Slot {
    const Effect* effect;
    int at, other, begin;  // begin of its memory
    Values p;
    double raw = 0, size = 1;  // the value it last saw
  };

  struct Point {
    State x;
    Hidden z;
  };

 public:
  SimulationRun(S& s, const SimulatorInfo& info, const SimulatorFacts& facts, const Sizes& sizes,
                const Recording& recording, const Eigen::VectorXd& p, const Augmentation& augmentation,
                const Integration& integration)
      : s_(s),
        info_(info),
        facts_(facts),
        recording_(recording),
        p_(p),
        integration_(integration),
        u_(info, recording) {
    inputs_ = static_cast<int>(info.inputs.size());
    any_driven_ = has_tap<S> && std::any_of(facts.driven_signal.begin(), facts.driven_signal.end(),
                                            [](bool driven) { return driven; });
    for (std::size_t i = 0; i < augmentation.effects.size(); ++i) add(augmentation, i, sizes);
    prepare(s_, p_);
  }

  SimulatedRun run(const Eigen::VectorXd& initial) {
    const Eigen::Index rows = recording_.rows(), n = initial.size();
    SimulatedRun result{Eigen::MatrixXd(static_cast<Eigen::Index>(info_.outputs.size()), rows),
                        Eigen::MatrixXd(n, rows)};
    Point now{converted<State>(initial), Hidden::Zero(memories_)};
    if (!sensors_.empty()) undo_sensors(now.x);
    if (memories_ > 0) start(now);
    for (Eigen::Index row = 0;; ++row) {
      result.states.col(row) = now.x;
      result.outputs.col(row) = observe(now, row);
      if (!now.x.allFinite()) {
        result.finite = false;
        return result;
      }
      if (row + 1 == rows) break;
      if (integration_.restart > 0 && row > 0 && row % integration_.restart == 0) restart(now, row);
      if (!drifts_.empty()) drift(row);
      advance_row(now, row);
    }
    for (const Slot& slot : sensors_) {
      Eigen::VectorXd readings = result.outputs.row(slot.at);
      slot.effect->sensor(
          {{recording_.time.data(), static_cast<std::size_t>(rows)}, {readings.data(), static_cast<std::size_t>(rows)}},
          slot.p);
      result.outputs.row(slot.at) = readings;
    }
    result.finite = result.outputs.allFinite();
    return result;
  }

  /// Force on each state (rate * effort), and each signal, at a point without effects: for sizes.
  void probe(const State& x, Eigen::Index row, Eigen::VectorXd& efforts, std::vector<double>& signals) {
    const Input u = u_.at_row(row);
    signals.resize(info_.signals.size());
    const State f = evaluate(s_, x, u, p_, [&](int i, double value) {
      signals[static_cast<std::size_t>(i)] = value;
      return value;
    });
    efforts = f;
    if constexpr (is_ode<S>) efforts.array() *= effort(x, u).array();
  }

 private:
  void add(const Augmentation& augmentation, std::size_t i, const Sizes& sizes) {
    const AttachedEffect& attached = augmentation.effects[i];
    const Effect& effect = *attached.effect;
    const Eigen::VectorXd& values = augmentation.values[i];
    const auto at = static_cast<std::size_t>(attached.at);
    Slot slot{
        &effect, attached.at, attached.other, memories_, {values.data(), static_cast<std::size_t>(values.size())}};
    memories_ += effect.memories;
    if (memories_ > 24) throw DiagnoseError("at most 24 hidden states of effects can be simulated at once");
    if (effect.place == Place::velocity || effect.place == Place::state) slot.size = sizes.state[at];
    if (effect.place == Place::input) {
      slot.size = attached.at < inputs_ ? sizes.input[at] : sizes.signal[at - static_cast<std::size_t>(inputs_)];
    }
    if (effect.delay && attached.at < inputs_) {
      u_.delay(attached.at, effect.delay(slot.p));
      late_ = true;
    }
    if (effect.signal) (attached.at < inputs_ ? orders_ : taps_).push_back(slot);
    if (effect.force || effect.memory_rate) {
      if (effect.place == Place::velocity || effect.place == Place::state) forces_.push_back(slot);
    }
    if (effect.dry) dry_.push_back(slot);
    if (effect.seen_position) seen_.push_back(slot);
    if (effect.limit) limits_.push_back(slot);
    if (effect.sensor) sensors_.push_back(slot);
    if (effect.planar) planar_.push_back(slot);
    if (effect.factor) drifts_.push_back(slot);
    if (effect.advance || effect.start) memory_.push_back(slot);
  }

  State effort(const State& x, const Input& u) const {
    if constexpr (requires { s_.effort(x, u, p_); }) {
      return s_.effort(x, u, p_);
    } else {
      State one = x;
      one.setOnes();
      return one;
    }
  }

  Moment moment(double value, double t, double h) const {
    Moment m;
    m.time = t - recording_.time[0];
    m.step = h;
    m.value = value;
    return m;
  }

  Moment moment_at_state(const Slot& slot, const Point& at, const State& f, const State& e, double t, double h) const {
    Moment m = moment(at.x[slot.at], t, h);
    const int position = facts_.position_of[static_cast<std::size_t>(slot.at)];
    if (position >= 0) m.position = at.x[position];
    m.rate = f[slot.at];
    m.effort = e[slot.at];
    return m;
  }

  Values hidden(const Slot& slot, const Hidden& z) const {
    return {z.data() + slot.begin, static_cast<std::size_t>(slot.effect->memories)};
  }
  Memory hidden(const Slot& slot, Hidden& z) const {
    return {z.data() + slot.begin, static_cast<std::size_t>(slot.effect->memories)};
  }

  /// An input or signal on its way through an effect.
  double through(Slot& slot, double value, const Point& at, Hidden& dz, double t, double h) {
    Moment m = moment(value, t, h);
    m.drive = value;
    slot.raw = value;
    if (slot.effect->memory_rate) slot.effect->memory_rate(m, slot.p, hidden(slot, at.z), hidden(slot, dz));
    return slot.effect->signal(m, slot.p, hidden(slot, at.z));
  }

  State equations(const State& x, const Input& u, const Point& at, Hidden& dz, double t, double h) {
    if (taps_.empty()) return evaluate(s_, x, u, p_, NoTap{});
    return evaluate(s_, x, u, p_, [&](int i, double value) { return tapped(i, value, at, dz, t, h); });
  }

  double tapped(int signal, double value, const Point& at, Hidden& dz, double t, double h) {
    for (Slot& slot : taps_) {
      if (slot.at == inputs_ + signal) value = through(slot, value, at, dz, t, h);
    }
    return value;
  }

  /// What outputs show in a row, with the effects on inputs and signals.
  typename S::Output observe(const Point& at, Eigen::Index row) {
    if (orders_.empty() && taps_.empty() && !late_) return s_.observe(at.x, u_.at_row(row), p_);
    u_.go_to(row);
    const double t = recording_.time[row];
    const double h = row + 1 < recording_.rows() ? recording_.time[row + 1] - t : t - recording_.time[row - 1];
    Hidden dz = Hidden::Zero(memories_);
    Input u = u_.between(t, h, 0);
    for (Slot& slot : orders_) u[slot.at] = through(slot, u[slot.at], at, dz, t, h);
    if constexpr (requires { s_.observe(at.x, u, p_, NoTap{}); }) {
      if (!taps_.empty()) {
        return s_.observe(at.x, u, p_, [&](int i, double value) { return tapped(i, value, at, dz, t, h); });
      }
    }
    return s_.observe(at.x, u, p_);
  }

  /// Splits the force on a state into what inputs cause and what remains at rest.
  void split_drive(Moment& m, const Slot& slot, const State& x, const Input& u) const {
    Input none = u;
    none.setZero();
    const auto undriven = [&](int i, double value) {
      return facts_.driven_signal[static_cast<std::size_t>(i)] ? 0.0 : value;
    };
    m.drive = m.effort * (m.rate - evaluate(s_, x, any_driven_ ? u : none, p_, undriven)[slot.at]);
    State rest = x;
    rest[slot.at] = 0;
    m.load = m.effort * evaluate(s_, rest, any_driven_ ? u : none, p_, undriven)[slot.at];
  }

  enum class Mode : signed char { back = -1, stuck = 0, forth = 1 };

  /// Rates of states and memories at a point, for a given mode of each dry friction.
  void rates(const Point& at, Input u, double t, double h, const std::vector<Mode>& modes, State& f, Hidden& dz) {
    dz.setZero(memories_);
    for (Slot& slot : orders_) u[slot.at] = through(slot, u[slot.at], at, dz, t, h);
    if (seen_.empty()) {
      f = equations(at.x, u, at, dz, t, h);
    } else {
      State seen = at.x;
      for (const Slot& slot : seen_) {
        const int position = facts_.position_of[static_cast<std::size_t>(slot.at)];
        if (position < 0) continue;
        Moment m = moment(at.x[slot.at], t, h);
        m.position = at.x[position];
        seen[position] = slot.effect->seen_position(m, slot.p, hidden(slot, at.z));
      }
      f = equations(seen, u, at, dz, t, h);
    }
    if (forces_.empty() && dry_.empty()) return;
    const State e = effort(at.x, u), model = f;
    for (const Slot& slot : forces_) {
      Moment m = moment_at_state(slot, at, model, e, t, h);
      if (slot.effect->needs_drive) split_drive(m, slot, at.x, u);
      if (slot.effect->memory_rate) slot.effect->memory_rate(m, slot.p, hidden(slot, at.z), hidden(slot, dz));
      if (slot.effect->force) {
        const double force = slot.effect->force(m, slot.p, hidden(slot, at.z));
        f[slot.at] += slot.effect->place == Place::velocity ? force / e[slot.at] : force;
      }
    }
    for (std::size_t i = 0; i < dry_.size(); ++i) {
      const Slot& slot = dry_[i];
      if (modes[i] == Mode::stuck) continue;
      f[slot.at] -= static_cast<double>(modes[i]) * level(slot, at, model, e, u, t, h) / e[slot.at];
    }
    for (std::size_t i = 0; i < dry_.size(); ++i) {
      if (modes[i] == Mode::stuck) f[dry_[i].at] = 0;
    }
  }

  double level(const Slot& slot, const Point& at, const State& f, const State& e, const Input& u, double t,
               double h) const {
    Moment m = moment_at_state(slot, at, f, e, t, h);
    if (slot.effect->needs_drive) split_drive(m, slot, at.x, u);
    return std::max(0.0, slot.effect->dry(m, slot.p));
  }

  /// Sliding or stuck: decided at the beginning of a step. Several dry frictions of one velocity add up.
  void decide(const Point& at, const Input& u, double t, double h, std::vector<Mode>& modes) {
    modes.assign(dry_.size(), Mode::stuck);
    std::vector<std::size_t> resting;
    for (std::size_t i = 0; i < dry_.size(); ++i) {
      const double v = at.x[dry_[i].at];
      if (std::abs(v) > 1e-12 * dry_[i].size) {
        modes[i] = v > 0 ? Mode::forth : Mode::back;
      } else {
        resting.push_back(i);
      }
    }
    if (resting.empty()) return;
    State f = at.x;
    Hidden dz;
    const std::vector<Slot> all = std::move(dry_);  // what would happen without dry friction
    dry_.clear();
    rates(at, u, t, h, modes, f, dz);
    dry_ = all;
    const State e = effort(at.x, u);
    for (const std::size_t i : resting) {
      double limit = 0;
      for (const std::size_t j : resting) {
        if (dry_[j].at == dry_[i].at) limit += level(dry_[j], at, f, e, u, t, h);
      }
      const double force = f[dry_[i].at] * e[dry_[i].at];
      if (std::abs(force) > limit) modes[i] = force > 0 ? Mode::forth : Mode::back;
    }
  }

  Point integrate(const Point& at, double t, double h, const std::vector<Mode>& modes) {
    State k1 = at.x, k2 = at.x;
    Hidden z1, z2;
    rates(at, u_.between(t, h, 0), t, h, modes, k1, z1);
    const Point half{at.x + 0.5 * h * k1, at.z + 0.5 * h * z1};
    const Input middle = u_.between(t, h, 0.5);
    rates(half, middle, t + 0.5 * h, h, modes, k2, z2);
    if (integration_.order == 2) return {at.x + h * k2, at.z + h * z2};
    State k3 = at.x, k4 = at.x;
    Hidden z3, z4;
    rates({at.x + 0.5 * h * k2, at.z + 0.5 * h * z2}, middle, t + 0.5 * h, h, modes, k3, z3);
    rates({at.x + h * k3, at.z + h * z3}, u_.between(t, h, 1), t + h, h, modes, k4, z4);
    return {at.x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), at.z + h / 6 * (z1 + 2 * z2 + 2 * z3 + z4)};
  }

  void step(Point& now, double t, double h, int depth) {
    if (dry_.empty()) {
      now = integrate(now, t, h, {});
      return;
    }
    std::vector<Mode> modes;
    decide(now, u_.between(t, h, 0), t, h, modes);
    Point next = integrate(now, t, h, modes);
    double cut = 1;  // share of the step after which the first velocity stops
    int stopped = -1;
    for (std::size_t i = 0; i < dry_.size(); ++i) {
      const double before = now.x[dry_[i].at], after = next.x[dry_[i].at];
      if (modes[i] == Mode::stuck || after * static_cast<double>(modes[i]) >= 0) continue;
      const double share = before == after ? 0 : before / (before - after);
      if (share < cut) {
        cut = std::clamp(share, 0.0, 1.0);
        stopped = dry_[i].at;
      }
    }
    if (stopped >= 0) {
      if (cut > 0) next = integrate(now, t, cut * h, modes);
      next.x[stopped] = 0;
      const double rest = (1 - cut) * h;
      now = next;
      if (depth < 4 && rest > 1e-9 * h) step(now, t + cut * h, rest, depth + 1);
      return;
    }
    now = next;
  }

  void advance_row(Point& now, Eigen::Index row) {
    const double from = recording_.time[row], length = recording_.time[row + 1] - from;
    u_.go_to(row);
    if constexpr (is_ode<S>) {
      const int steps =
          integration_.step > 0 ? std::max(1, static_cast<int>(std::ceil(length / integration_.step - 1e-6))) : 1;
      const double h = length / steps;
      for (int i = 0; i < steps; ++i) {
        const double t = from + i * h;
        step(now, t, h, 0);
        after_step(now, t, h);
      }
    } else {
      const State before = now.x;
      Hidden dz = Hidden::Zero(memories_);
      Input u = u_.between(from, 1, 0);
      for (Slot& slot : orders_) u[slot.at] = through(slot, u[slot.at], now, dz, from, 1);
      now.x = equations(before, u, now, dz, from, 1);
      for (const Slot& slot : forces_) {
        Moment m = moment(before[slot.at], from, 1);
        m.rate = now.x[slot.at] - before[slot.at];
        if (slot.effect->force) now.x[slot.at] += slot.effect->force(m, slot.p, hidden(slot, now.z));
      }
      if (!planar_.empty()) move_in_plane(before, now.x);
      now.z += dz;
      after_step(now, from, 1);
    }
  }

  void move_in_plane(const State& before, State& after) const {
    const PlanarInfo& at = *info_.planar;
    const double heading = before[at.heading], c = std::cos(heading), s = std::sin(heading);
    const double x = after[at.x] - before[at.x], y = after[at.y] - before[at.y];
    Pose2 moved{c * x + s * y, -s * x + c * y, after[at.heading] - heading};
    for (const Slot& slot : planar_) moved = slot.effect->planar(moved, heading, slot.p);
    after[at.x] = before[at.x] + c * moved.x - s * moved.y;
    after[at.y] = before[at.y] + s * moved.x + c * moved.y;
    after[at.heading] = heading + moved.angle;
  }

  void after_step(Point& now, double t, double h) {
    for (Slot& slot : memory_) {
      if (!slot.effect->advance) continue;
      slot.effect->advance(memory_moment(slot, now, t, h), slot.p, hidden(slot, now.z));
    }
    for (const Slot& slot : limits_) {
      const int position = facts_.position_of[static_cast<std::size_t>(slot.at)];
      double no_position = 0, no_other = 0;
      slot.effect->limit(slot.p, now.x[slot.at], position >= 0 ? now.x[position] : no_position,
                         slot.other >= 0 ? now.x[slot.other] : no_other);
    }
  }

  Moment memory_moment(const Slot& slot, const Point& now, double t, double h) const {
    if (slot.effect->place == Place::input) {
      double raw = 0;
      for (const auto* group : {&orders_, &taps_}) {
        for (const Slot& user : *group) {
          if (user.begin == slot.begin && user.effect == slot.effect) raw = user.raw;
        }
      }
      return moment(raw, t, h);
    }
    Moment m = moment(now.x[slot.at], t, h);
    const int position = facts_.position_of[static_cast<std::size_t>(slot.at)];
    if (position >= 0) m.position = now.x[position];
    return m;
  }

  void start(Point& now) {
    State f = now.x;
    Hidden dz;
    u_.go_to(0);
    const double t = recording_.time[0];
    const std::vector<Mode> sliding(dry_.size(), Mode::forth);
    rates(now, u_.between(t, 1e-9, 0), t, 1e-9, sliding, f, dz);  // so that effects have seen their first value
    for (const Slot& slot : memory_) {
      if (slot.effect->start) slot.effect->start(memory_moment(slot, now, t, 0), slot.p, hidden(slot, now.z));
    }
  }

  /// An initial state that was read off a sensor has the fault of that sensor, which is taken out again.
  void undo_sensors(State& x) const {
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const auto state = static_cast<Eigen::Index>(i);
      const int output = facts_.output_of[i];
      if (output < 0 || x[state] != recording_.outputs(output, 0)) continue;
      const double read = x[state], time = 0;
      for (int round = 0; round < 3; ++round) {
        double reading = x[state];
        for (const Slot& slot : sensors_) {
          if (slot.at == output && slot.effect->at_start) slot.effect->sensor({{&time, 1}, {&reading, 1}}, slot.p);
        }
        x[state] += read - reading;
      }
    }
  }

  void restart(Point& now, Eigen::Index row) const {
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const int output = facts_.output_of[i];
      if (output < 0) continue;
      const double measured = recording_.outputs(output, row);
      if (std::isfinite(measured)) now.x[static_cast<Eigen::Index>(i)] = measured;
    }
  }

  void drift(Eigen::Index row) {
    Eigen::VectorXd p = nominal_.size() > 0 ? nominal_ : p_;
    if (nominal_.size() == 0) nominal_ = p_;
    for (const Slot& slot : drifts_) {
      Moment m;
      m.time = recording_.time[row] - recording_.time[0];
      p[slot.at] *= slot.effect->factor(m, slot.p);
    }
    p_ = p;
    prepare(s_, p_);
  }

  S& s_;
  const SimulatorInfo& info_;
  const SimulatorFacts& facts_;
  const Recording& recording_;
  Eigen::VectorXd p_, nominal_;
  Integration integration_;
  HeldInput<Input> u_;
  int inputs_ = 0, memories_ = 0;
  bool late_ = false;        // some input has a delay
  bool any_driven_ = false;  // some signal inside the equations depends on the inputs
  std::vector<Slot> orders_, taps_, forces_, dry_, seen_, limits_, sensors_, planar_, drifts_, memory_;
};

}  // namespace detail

}  // namespace surefoot

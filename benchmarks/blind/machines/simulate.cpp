#include "simulate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "laws.hpp"

namespace machines {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

class Run {
 public:
  Run(const CompiledMachine& compiled, const Values& parameters, const std::vector<Hidden>& hidden,
      const Recording& recording, const plants::How& how)
      : compiled_(compiled),
        parameters_(parameters),
        hidden_(hidden),
        recording_(recording),
        how_(how),
        registers_(compiled.registers),
        states_(compiled.states.size()),
        y_(states_ + hidden_size * hidden.size(), 0.0),
        held_(hidden.size(), 0.0),
        held_at_(hidden.size(), recording.time.empty() ? 0.0 : recording.time[0]),
        past_(hidden.size()) {
    for (std::size_t i = 0; i < parameters.size(); ++i) reg(compiled_.parameters[i]) = parameters[i];
    std::size_t meta = 0;
    for (std::size_t i = 0; i < compiled_.constants.size(); ++i) {
      const Constant& constant = compiled_.machine.constants[i];
      reg(compiled_.constants[i]) = constant.meta.empty() ? constant.value : recording_.meta[meta++].second;
    }
    for (const Hidden& one : hidden_) {
      drifting_ |= one.where == Where::parameter;
      tapped_ |= one.where == Where::signal;
      late_sensors_ |= one.law == Law::sensor_delay;
    }
  }

  plants::Series run(bool with_signals) {
    const std::vector<Column> inputs = fine_inputs();
    start(inputs);
    plants::Series series;
    series.states.resize(states_ + (with_signals ? compiled_.signals.size() : 0));
    series.outputs.resize(compiled_.outputs.size());
    const auto fine = at(how_.substeps);
    for (std::size_t row = 0; row < recording_.time.size(); ++row) {
      take(series, inputs, std::min(row * fine, inputs[0].size() - 1), recording_.time[row], with_signals);
      if (row + 1 == recording_.time.size()) break;
      const double step = (recording_.time[row + 1] - recording_.time[row]) / how_.substeps;
      for (std::size_t k = 0; k < fine; ++k) {
        for (std::size_t i = 0; i < inputs.size(); ++i) reg(compiled_.inputs[i]) = inputs[i][row * fine + k];
        const double time = recording_.time[row] + static_cast<double>(k) * step;
        if (late_sensors_) remember_outputs(time);
        advance(time, step);
      }
    }
    if (late_sensors_) remember_outputs(recording_.time.back());
    for (const Hidden& one : hidden_) {
      if (one.where != Where::sensor) continue;
      Column& readings = series.outputs[at(one.target)];
      if (one.law == Law::sensor_delay) {
        readings = late(outputs_[at(one.target)], one.a);
      } else {
        change_readings(how_.unrounded ? unrounded(one) : one, recording_.time, readings);
      }
    }
    return series;
  }

 private:
  double& reg(int index) { return registers_[at(index)]; }

  void remember_outputs(double time) {
    for (std::size_t i = 0; i < states_; ++i) reg(compiled_.states[i]) = y_[i];
    fine_times_.push_back(time);
    outputs_.resize(compiled_.outputs.size());
    for (std::size_t k = 0; k < outputs_.size(); ++k) {
      evaluate(compiled_.outputs[k].steps, registers_);
      outputs_[k].push_back(reg(compiled_.outputs[k].result));
    }
  }

  // What an output was at the rows minus the delay.
  Column late(const Column& values, double delay) const {
    Column readings;
    std::size_t from = 0;
    for (const double now : recording_.time) {
      const double then = std::max(now - delay, fine_times_[0]);
      while (from + 2 < fine_times_.size() && fine_times_[from + 1] <= then) ++from;
      const double share = (then - fine_times_[from]) / (fine_times_[from + 1] - fine_times_[from]);
      readings.push_back(values[from] + share * (values[from + 1] - values[from]));
    }
    return readings;
  }

  // Whether an input changes from most rows to the next: steps stay steps.
  static bool moves(const Column& column) {
    std::size_t changes = 0;
    for (std::size_t row = 1; row < column.size(); ++row) changes += column[row] != column[row - 1] ? 1 : 0;
    return 2 * changes > column.size();
  }

  // An input during a fine step: as in its row, or at the step's middle on the way to the next one.
  double input(const Column& column, bool linear, std::size_t step) const {
    const std::size_t row = step / at(how_.substeps), within = step % at(how_.substeps);
    if (!linear) return column[row];
    const double share = (static_cast<double>(within) + 0.5) / how_.substeps;
    return column[row] + share * (column[row + 1] - column[row]);
  }

  std::vector<Column> fine_inputs() const {
    Column times;
    for (std::size_t row = 0; row + 1 < recording_.time.size(); ++row) {
      const double step = (recording_.time[row + 1] - recording_.time[row]) / how_.substeps;
      for (int k = 0; k < how_.substeps; ++k) times.push_back(recording_.time[row] + k * step);
    }
    std::vector<Column> inputs(recording_.inputs.size());
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const Column& rows = recording_.inputs[i];
      const bool linear = compiled_.machine.linear_inputs && moves(rows);
      for (std::size_t k = 0; k < times.size(); ++k) inputs[i].push_back(input(rows, linear, k));
      for (const Hidden& one : hidden_)
        if (one.where == Where::input && at(one.target) == i) change_input(one, times, inputs[i]);
    }
    return inputs;
  }

  // Initial values as the model file says them; "free" ones are the true ones.
  void start(const std::vector<Column>& inputs) {
    for (std::size_t i = 0; i < states_; ++i) {
      y_[i] = recording_.initial[i];
      const std::string& initial = compiled_.machine.states[i].initial;
      if (!how_.from_readings || initial.rfind("column:", 0) != 0) continue;
      for (std::size_t k = 0; k < compiled_.outputs.size(); ++k)
        if ("column:" + compiled_.machine.outputs[k].column == initial) y_[i] = recording_.readings[k][0];
    }
    for (std::size_t i = 0; i < inputs.size(); ++i) reg(compiled_.inputs[i]) = inputs[i].empty() ? 0 : inputs[i][0];
    for (std::size_t k = 0; k < hidden_.size(); ++k) {
      const Hidden& one = hidden_[k];
      double* own = &y_[states_ + hidden_size * k];
      if (one.where != Where::speed) continue;
      const int position = compiled_.machine.states[at(one.target)].position;
      const double q = position < 0 ? 0 : y_[at(position)];
      held_[k] = one.law == Law::seen_backlash ? q : 0;
      for (std::size_t i = 0; i < hidden_size; i += 2) own[i] = has_second_mass(one.law) ? q : 0;
    }
    starting_ = true;
    std::vector<double> rates;
    evaluate_rates(recording_.time[0], y_, rates);  // signals with a memory begin where they are
    starting_ = false;
  }

  // Signals and rates of the model without hidden forces, for the states y.
  void evaluate_model(double time, const std::vector<double>& y) {
    for (std::size_t i = 0; i < states_; ++i) reg(compiled_.states[i]) = y[i];
    for (std::size_t k = 0; k < hidden_.size(); ++k) {
      if (hidden_[k].law != Law::seen_backlash) continue;
      const std::size_t position = at(compiled_.machine.states[at(hidden_[k].target)].position);
      reg(compiled_.states[position]) = within(held_[k], y[position], hidden_[k].a);
    }
    if (drifting_) drift(time);
    for (std::size_t i = 0; i < compiled_.signals.size(); ++i) {
      const Formula& formula = compiled_.signal_formulas[i];
      evaluate(formula.steps, registers_);
      double value = reg(formula.result);
      if (tapped_) value = through_effects(i, value, time, y);
      reg(compiled_.signals[i]) = value;
    }
    for (std::size_t i = 0; i < states_; ++i) evaluate(compiled_.rates[i].steps, registers_);
  }

  void drift(double time) {
    for (std::size_t i = 0; i < parameters_.size(); ++i) reg(compiled_.parameters[i]) = parameters_[i];
    for (const Hidden& one : hidden_)
      if (one.where == Where::parameter)
        reg(compiled_.parameters[at(one.target)]) *= factor_of_parameter(one, time - recording_.time[0]);
  }

  double through_effects(std::size_t signal, double value, double time, const std::vector<double>& y) {
    for (std::size_t k = 0; k < hidden_.size(); ++k) {
      const Hidden& one = hidden_[k];
      if (one.where != Where::signal || at(one.target) != signal) continue;
      const std::size_t own = states_ + hidden_size * k;
      const int lags = lags_of(one.law);
      if (starting_) {
        held_[k] = value;
        std::fill_n(&y_[own], hidden_size, value);
      }
      asked_now_ = value;
      if (lags > 0) {
        value = starting_ ? value : y[own + at(lags) - 1];
      } else if (one.law == Law::rate_limit) {
        const double reach = one.a * (time - held_at_[k]);
        value = starting_ ? value : within(value, held_[k], reach);
      } else if (one.law == Law::delay) {
        value = past_[k].empty() ? value : past_[k].value_at(time - one.a);
      } else {
        value = static_signal(one, value, time - recording_.time[0]);
      }
      if (has_memory(one.law)) held_asked_[k % held_asked_.size()] = asked_now_;
    }
    return value;
  }

  void evaluate_rates(double time, const std::vector<double>& y, std::vector<double>& rates) {
    evaluate_model(time, y);
    rates.assign(y_.size(), 0.0);
    for (std::size_t i = 0; i < states_; ++i) rates[i] = reg(compiled_.rates[i].result);
    for (std::size_t k = 0; k < hidden_.size(); ++k) {
      const Hidden& one = hidden_[k];
      const std::size_t own = states_ + hidden_size * k;
      const std::span<const double> memory(&y[own], hidden_size);
      const std::span<double> change(&rates[own], hidden_size);
      const int lags = lags_of(one.law);
      if (one.where == Where::signal && lags > 0) {
        double asked = held_asked_[k % held_asked_.size()];
        for (std::size_t n = 0; n < at(lags); ++n) {
          change[n] = (asked - memory[n]) * lags / one.a;
          asked = memory[n];
        }
      } else if (one.where == Where::speed) {
        const Motion motion = motion_of(one, time, y, rates);
        rates[at(one.target)] += force_of(one, motion, memory, held_[k], change) / motion.inertia;
      } else if (one.where == Where::state) {
        Surroundings around{time - recording_.time[0], y[at(one.target)], 0};
        if (one.other >= 0) around.other = y[at(one.other)];
        const double extra = rate_of(one, around);
        rates[at(one.target)] += extra;
        if (one.law == Law::exchange) rates[at(one.other)] -= extra;
      }
    }
  }

  Motion motion_of(const Hidden& one, double time, const std::vector<double>& y, const std::vector<double>& rates) {
    const State& state = compiled_.machine.states[at(one.target)];
    Motion motion;
    motion.time = time - recording_.time[0];
    motion.speed = y[at(one.target)];
    motion.position = state.position < 0 ? 0 : y[at(state.position)];
    const Formula& effort = compiled_.efforts[at(one.target)];
    if (effort.result >= 0) {
      evaluate(effort.steps, registers_);
      motion.inertia = reg(effort.result);
    }
    motion.rate = rates[at(one.target)];
    const int drive = compiled_.drives[at(one.target)], load = compiled_.loads[at(one.target)];
    motion.drive = drive < 0 ? motion.rate * motion.inertia : reg(drive);
    motion.load = load < 0 ? 0 : reg(load);
    motion.period = compiled_.machine.period;
    return motion;
  }

  void advance(double time, double step) {
    const std::vector<double> start = y_;
    auto& [k1, k2, k3, k4] = slopes_;
    const auto stage = [&](const std::vector<double>& slope, double share) {
      for (std::size_t i = 0; i < y_.size(); ++i) stage_[i] = start[i] + share * step * slope[i];
    };
    stage_ = y_;
    evaluate_rates(time, stage_, k1);
    stage(k1, 0.5);
    evaluate_rates(time + step / 2, stage_, k2);
    stage(k2, 0.5);
    evaluate_rates(time + step / 2, stage_, k3);
    stage(k3, 1);
    evaluate_rates(time + step, stage_, k4);
    for (std::size_t i = 0; i < y_.size(); ++i) y_[i] = start[i] + step / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    if (!hidden_.empty()) settle(time + step, step);
  }

  // Everything that changes once per step.
  void settle(double time, double step) {
    for (std::size_t k = 0; k < hidden_.size(); ++k) {
      const Hidden& one = hidden_[k];
      if (one.where == Where::signal && has_memory(one.law)) {
        const double asked = held_asked_[k % held_asked_.size()];
        if (one.law == Law::rate_limit) held_[k] += std::clamp(asked - held_[k], -one.a * step, one.a * step);
        held_at_[k] = time;
        if (one.law == Law::delay) past_[k].add(time, asked, one.a);
      } else if (one.where == Where::state && one.law == Law::overflow) {
        double& amount = y_[at(one.target)];
        if (one.other >= 0) y_[at(one.other)] += one.b * std::max(amount - one.a, 0.0);
        amount = std::min(amount, one.a);
      } else if (one.where == Where::speed) {
        settle_speed(one, k, time, step);
      }
    }
  }

  void settle_speed(const Hidden& one, std::size_t k, double time, double step) {
    const int position = compiled_.machine.states[at(one.target)].position;
    if (has_bristles(one.law)) {
      std::vector<double>& rates = slopes_[0];
      evaluate_model(time, y_);
      for (std::size_t i = 0; i < states_; ++i) rates[i] = reg(compiled_.rates[i].result);
      held_[k] = next_deflection(one, motion_of(one, time, y_, rates), held_[k], step);
    } else if (one.law == Law::seen_backlash) {
      held_[k] = within(held_[k], y_[at(position)], one.a);
    } else if (one.law == Law::hard_stop && (y_[at(position)] - one.a) * one.b > 0) {
      y_[at(position)] = one.a;
      double& speed = y_[at(one.target)];
      if (speed * one.b > 0) speed *= -one.c;
    }
  }

  void take(plants::Series& series, const std::vector<Column>& inputs, std::size_t fine, double time,
            bool with_signals) {
    if (with_signals) {
      for (std::size_t i = 0; i < inputs.size(); ++i) reg(compiled_.inputs[i]) = inputs[i][fine];
      evaluate_model(time, y_);
      for (std::size_t i = 0; i < compiled_.signals.size(); ++i)
        series.states[states_ + i].push_back(reg(compiled_.signals[i]));
    }
    for (std::size_t i = 0; i < states_; ++i) {
      reg(compiled_.states[i]) = y_[i];
      series.states[i].push_back(y_[i]);
    }
    for (std::size_t k = 0; k < compiled_.outputs.size(); ++k) {
      evaluate(compiled_.outputs[k].steps, registers_);
      series.outputs[k].push_back(reg(compiled_.outputs[k].result));
    }
  }

  const CompiledMachine& compiled_;
  const Values& parameters_;
  const std::vector<Hidden>& hidden_;
  const Recording& recording_;
  plants::How how_;
  std::vector<double> registers_;
  std::size_t states_;
  std::vector<double> y_;  // states, then hidden_size per effect
  std::vector<double> held_, held_at_;  // and since when [s]
  std::vector<Past> past_;
  std::array<double, 4> held_asked_{};  // what was asked of signals with a memory, by effect
  double asked_now_ = 0;
  std::array<std::vector<double>, 4> slopes_;
  std::vector<double> stage_;
  Column fine_times_;  // and outputs at them, where a sensor is late
  std::vector<Column> outputs_;
  bool drifting_ = false, tapped_ = false, late_sensors_ = false, starting_ = false;
};

}  // namespace

plants::Series simulate(const CompiledMachine& machine, const Values& parameters, const std::vector<Hidden>& hidden,
                        const Recording& recording, const plants::How& how, bool with_signals) {
  return Run(machine, parameters, hidden, recording, how).run(with_signals);
}

}  // namespace machines

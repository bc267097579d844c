// Formulas of hidden physics. Nothing here is taken from the library: what it calls by the same name has mostly another
// formula here.
#pragma once

#include <algorithm>
#include <deque>
#include <span>

#include "machine.hpp"

namespace machines {

/// Hidden states of an effect that are integrated.
constexpr std::size_t hidden_size = 4;

/// What moves at one instant, with the speed that a force acts on.
struct Motion {
  double time = 0;      // since the first row [s]
  double position = 0;  // of what it is the speed
  double speed = 0;
  double rate = 0;     // of the speed, without hidden forces
  double inertia = 1;  // turns a rate into a force
  double drive = 0;    // of the motor
  double load = 0;     // weight or spring
  double period = 0;   // between rows [s]
};

/// What an effect on another state looks at.
struct Surroundings {
  double time = 0, amount = 0, other = 0;
};

/// Past values of a signal.
class Past {
 public:
  bool empty() const { return values_.empty(); }
  /// The older half of what no delay needs any more is dropped.
  void add(double time, double value, double longest);
  double value_at(double time) const;

 private:
  std::deque<std::pair<double, double>> values_;
};

inline double within(double value, double middle, double half_width) {
  return std::clamp(value, middle - half_width, middle + half_width);
}

bool has_bristles(Law law);
bool has_second_mass(Law law);
/// Signals that depend on what was asked before.
bool has_memory(Law law);
/// Equal lags in a row, which share its time; 0: it is no lag.
int lags_of(Law law);

double force_of(const Hidden& one, const Motion& motion, std::span<const double> memory, double held,
                std::span<double> change);
/// Bristles after a step at constant speed, exact.
double next_deflection(const Hidden& one, const Motion& motion, double deflection, double step);

/// Addition to the rate of a state that no forces act on.
double rate_of(const Hidden& one, const Surroundings& around);

double static_signal(const Hidden& one, double value, double time);
/// An input over the fine steps, in place; `times`: starts of the steps [s].
void change_input(const Hidden& one, const Column& times, Column& values);
double factor_of_parameter(const Hidden& one, double time);
/// Whether readings come in steps.
bool rounds(Law law);
/// The law whose readings are those of one that rounds in the mean, and smooth.
Hidden unrounded(Hidden one);
/// What a sensor makes of the true values; delays need what lies between the rows and are not among it.
void change_readings(const Hidden& one, const Column& times, Column& values);

}  // namespace machines

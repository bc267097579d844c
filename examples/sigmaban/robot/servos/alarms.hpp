// Temperature and voltage beyond what is good for a servo.
#pragma once

#include <algorithm>

#include "../dynamixel/control_tables.hpp"

namespace dynamixel {

struct AlarmOptions {
  double hot_celsius = 65;        // MX servos switch themselves off at 80
  double cool_celsius = 60;       // below it a hot servo counts as cool again
  double low_voltage_v = 10.5;    // three cells nearly empty
  double high_voltage_v = 14.8;   // what an MX-64 may get
  double voltage_margin_v = 0.3;  // by which a voltage must be right again
};

/// Of servos of that model: those for 12 V within their own limits, others by their own limits alone.
inline AlarmOptions alarms_of(const ServoModel& model) {
  constexpr double three_cells_v = 11;  // what is made for more than that is fed by three cells [V]
  AlarmOptions alarms;
  const double low = model.factory.min_voltage_limit * voltage_v, high = model.factory.max_voltage_limit * voltage_v;
  const bool cells = model.factory.supply_v > three_cells_v;
  alarms.low_voltage_v = cells ? std::max(alarms.low_voltage_v, low) : low;
  alarms.high_voltage_v = cells ? std::min(alarms.high_voltage_v, high) : high;
  alarms.hot_celsius = std::min(alarms.hot_celsius, model.factory.temperature_limit - 5.0);
  alarms.cool_celsius = std::min(alarms.cool_celsius, alarms.hot_celsius - 5);
  return alarms;
}

struct Alarms {
  bool hot = false;
  bool voltage = false;

  bool operator==(const Alarms&) const = default;
};

/// With a gap between coming and going, so that an alarm does not flicker.
inline Alarms update_alarms(Alarms before, double celsius, double volts, const AlarmOptions& options) {
  const double margin = before.voltage ? options.voltage_margin_v : 0.0;
  return {celsius >= (before.hot ? options.cool_celsius : options.hot_celsius),
          volts < options.low_voltage_v + margin || volts > options.high_voltage_v - margin};
}

}  // namespace dynamixel

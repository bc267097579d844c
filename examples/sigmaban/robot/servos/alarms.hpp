// Temperature and voltage beyond what is good for a servo.
#pragma once

namespace dynamixel {

struct AlarmOptions {
  double hot_celsius = 65;        // MX servos switch themselves off at 80
  double cool_celsius = 60;       // below it a hot servo counts as cool again
  double low_voltage_v = 10.5;    // three cells nearly empty
  double high_voltage_v = 14.8;   // what an MX-64 may get
  double voltage_margin_v = 0.3;  // by which a voltage must be right again
};

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

// What servos say of themselves, as text.
#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "servo_line.hpp"
#include "servo_settings.hpp"

namespace dynamixel {

constexpr std::string_view name_of(Unit unit) {
  constexpr std::string_view names[] = {"", "rad", "rad/s", "rad/s2", "s", "V", "degrees C", "A", "of the maximum"};
  return names[static_cast<std::size_t>(unit)];
}

/// The value of the first of these registers that the model has, in its unit; "-" where it has none.
template <class ServoBus>
std::string shown(ServoSettings<ServoBus>& servo, std::initializer_list<std::string_view> names, double scale = 1,
                  const char* format = "%.3g") {
  for (const std::string_view name : names) {
    const Register* r = servo.model().find(name);
    if (r == nullptr) continue;
    double value = value_from_bits(*r, servo.read(*r));
    if (r->unit == Unit::radian) value -= servo.model().center * servo.model().tick_rad;
    char text[32];
    std::snprintf(text, sizeof text, format, scale * value);
    return text;
  }
  return "-";
}

/// A line for each.
template <class ServoBus>
void show_briefly(ServoBus& bus, const std::vector<std::uint8_t>& ids) {
  std::printf("%4s  %-12s %8s %8s %12s %9s %7s %12s %14s %6s %6s\n", "id", "model", "firmware", "at rad", "delay us",
              "supply V", "heat C", "limits V", "limits rad", "torque", "error");
  for (const std::uint8_t id : ids) {
    const ServoModel* model = model_of(bus, id);
    if (model == nullptr) {
      std::printf("%4d  does not answer\n", id);
      continue;
    }
    ServoSettings<ServoBus> servo(bus, *model, id);
    const std::string volts = shown(servo, {"min_voltage_limit"}) + " to " + shown(servo, {"max_voltage_limit"});
    const std::string angles = shown(servo, {"min_position_limit", "cw_angle_limit"}) + " to " +
                               shown(servo, {"max_position_limit", "ccw_angle_limit"});
    std::printf("%4d  %-12s %8s %8s %12s %9s %7s %12s %14s %6s %6s\n", id, std::string(model->name).c_str(),
                shown(servo, {"firmware_version"}).c_str(), shown(servo, {"present_position"}, 1, "%.3f").c_str(),
                shown(servo, {"return_delay_time"}, 1e6).c_str(),
                shown(servo, {"present_input_voltage", "present_voltage"}, 1, "%.1f").c_str(),
                shown(servo, {"present_temperature"}).c_str(), volts.c_str(), angles.c_str(),
                shown(servo, {"torque_enable"}).c_str(), shown(servo, {"hardware_error_status"}).c_str());
  }
}

/// Every register of each.
template <class ServoBus>
void show_all(ServoBus& bus, const std::vector<std::uint8_t>& ids) {
  for (const std::uint8_t id : ids) {
    const ServoModel* model = model_of(bus, id);
    if (model == nullptr) throw BusError("servo " + std::to_string(id) + " does not answer");
    ServoSettings<ServoBus> servo(bus, *model, id);
    std::printf("servo %d, %s\n", id, std::string(model->name).c_str());
    for (const Register& r : model->registers) {
      if (r.repeats > 1) continue;
      const std::uint32_t counts = servo.read(r);
      std::printf("  %3d  %-24s %10u  %12.6g %-15s %s%s\n", r.address, std::string(r.name).c_str(), counts,
                  value_from_bits(r, counts), std::string(name_of(r.unit)).c_str(),
                  r.access == Access::read_only ? "read only" : "",
                  r.access != Access::read_only && r.address >= model->first_ram_address ? "lost without power" : "");
    }
  }
}

}  // namespace dynamixel

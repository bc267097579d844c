// The registers that a virtual servo looks at all the time.
#pragma once

#include "../dynamixel/control_tables.hpp"

namespace dynamixel {

/// Null where the model has none of that name.
struct VirtualServoRegisters {
  explicit VirtualServoRegisters(const ServoModel& model)
      : id(model.find("id")),
        baud_rate(model.find("baud_rate")),
        goal_position(model.find("goal_position")),
        torque_enable(model.find("torque_enable")),
        torque_limit(model.find("torque_limit")),
        status_return_level(model.find("status_return_level")),
        temperature_limit(model.find("temperature_limit")),
        min_voltage_limit(model.find("min_voltage_limit")),
        max_voltage_limit(model.find("max_voltage_limit")),
        return_delay_time(model.find("return_delay_time")),
        bus_watchdog(model.find("bus_watchdog")),
        p_gain(model.find("p_gain")),
        position_p_gain(model.find("position_p_gain")),
        present_position(model.find("present_position")),
        present_velocity(model.find("present_velocity")),
        present_speed(model.find("present_speed")),
        position_trajectory(model.find("position_trajectory")),
        present_current(model.find("present_current")),
        current(model.find("current")),
        present_voltage(model.find("present_voltage")),
        present_input_voltage(model.find("present_input_voltage")),
        present_temperature(model.find("present_temperature")),
        hardware_error_status(model.find("hardware_error_status")),
        realtime_tick(model.find("realtime_tick")),
        registered(model.find(model.protocol == 1 ? "registered" : "registered_instruction")),
        pwm_limit(model.find("pwm_limit")),
        cw_angle_limit(model.find("cw_angle_limit")),
        min_position_limit(model.find("min_position_limit")),
        ccw_angle_limit(model.find("ccw_angle_limit")),
        max_position_limit(model.find("max_position_limit")) {}
  const Register *id, *baud_rate, *goal_position, *torque_enable, *torque_limit, *status_return_level,
      *temperature_limit, *min_voltage_limit, *max_voltage_limit, *return_delay_time, *bus_watchdog, *p_gain,
      *position_p_gain, *present_position, *present_velocity, *present_speed, *position_trajectory, *present_current,
      *current, *present_voltage, *present_input_voltage, *present_temperature, *hardware_error_status, *realtime_tick,
      *registered, *pwm_limit, *cw_angle_limit, *min_position_limit, *ccw_angle_limit, *max_position_limit;
};

}  // namespace dynamixel

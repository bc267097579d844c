// The body's sensors as devices on a servo bus: an inertial unit, and a board with load cells in each foot.
//
// The control tables are those of Rhoban's boards (github.com/Rhoban): readings from address 36 on, of an inertial unit
// with the sensors of a GY-85 as signed numbers of 16 bits, of a foot with four cells as signed numbers of 24 bits.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "../bus/transport.hpp"
#include "../dynamixel/control_tables.hpp"
#include "../dynamixel/units.hpp"
#include "body_reading.hpp"

namespace dynamixel {

inline constexpr double gyro_rad_per_s = degree_rad / 14.375;    // of a count of the ITG-3200 [rad/s]
inline constexpr double accelerometer_m_per_s2 = 9.80665 / 256;  // of a count of the ADXL345 [m/s^2]

namespace control_table_detail {

inline constexpr std::array inertial_unit{
    Register{"model_number", 0, 2, read_only},
    Register{"firmware_version", 2, 1, read_only},
    Register{"id", 3, 1, read_write},
    Register{"accelerometer_x", 36, 2, read_only, Unit::none, accelerometer_m_per_s2, Encoding::signed_value},
    Register{"accelerometer_y", 38, 2, read_only, Unit::none, accelerometer_m_per_s2, Encoding::signed_value},
    Register{"accelerometer_z", 40, 2, read_only, Unit::none, accelerometer_m_per_s2, Encoding::signed_value},
    Register{"gyro_x", 42, 2, read_only, Unit::radian_per_second, gyro_rad_per_s, Encoding::signed_value},
    Register{"gyro_y", 44, 2, read_only, Unit::radian_per_second, gyro_rad_per_s, Encoding::signed_value},
    Register{"gyro_z", 46, 2, read_only, Unit::radian_per_second, gyro_rad_per_s, Encoding::signed_value}};

inline constexpr std::array load_cells{Register{"model_number", 0, 2, read_only},
                                       Register{"firmware_version", 2, 1, read_only},
                                       Register{"id", 3, 1, read_write},
                                       Register{"cell_1", 36, 3, read_only, Unit::none, 1, Encoding::signed_value},
                                       Register{"cell_2", 39, 3, read_only, Unit::none, 1, Encoding::signed_value},
                                       Register{"cell_3", 42, 3, read_only, Unit::none, 1, Encoding::signed_value},
                                       Register{"cell_4", 45, 3, read_only, Unit::none, 1, Encoding::signed_value}};

}  // namespace control_table_detail

inline constexpr ServoModel inertial_unit{
    .name = "GY-85", .protocol = 1, .first_ram_address = 24, .registers = control_table_detail::inertial_unit};
inline constexpr ServoModel load_cells{.name = "ForceFoot",
                                       .model_number = 5004,
                                       .protocol = 1,
                                       .first_ram_address = 24,
                                       .registers = control_table_detail::load_cells};

/// Which devices, and what a count of a cell means.
struct BusSensorsOptions {
  std::array<int, 3> ids{120, 121, 122};                      // inertial unit, left foot, right foot
  double newton_per_count = 1;                                // of a cell
  std::array<double, 2> unloaded_counts{};                    // of all four cells of a foot in the air, left and right
  std::array<double, 4> cell_x = {0.06, 0.06, -0.06, -0.06};  // ahead of the foot's middle [m]
  double longest_s = 4.5e-3;                                  // that reading all of them may take [s]
};

/// `SensorBus` is a Bus of Protocol 1.0. A device that does not answer is asked again in the next cycle.
template <class SensorBus>
class BusSensors {
 public:
  explicit BusSensors(SensorBus& bus, const BusSensorsOptions& options = {}) : bus_(&bus), options_(options) {}

  std::optional<sigmaban::BodyReading> feel() {
    constexpr std::uint16_t begin = 36;
    constexpr std::size_t count = 12;  // bytes of a device's readings
    std::array<std::uint8_t, 3 * count> bytes{};
    for (std::size_t i = 0; i < options_.ids.size(); ++i) {  // one by one: these boards know no bulk read
      const Time deadline = bus_->port().now() + from_seconds(options_.longest_s / 3);
      const auto id = static_cast<std::uint8_t>(options_.ids[i]);
      if (!bus_->read(id, begin, Buffer(bytes).subspan(count * i, count), deadline)) return std::nullopt;
    }
    sigmaban::BodyReading reading;
    const auto value = [&](std::size_t device, const ServoModel& model, std::size_t place) {
      const Register& r = model.registers[first_reading + place];
      return value_from_bits(r, bits_in(Bytes(bytes).subspan(count * device, count), begin, r));
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      reading.accelerometer[axis] = value(0, inertial_unit, k);
      reading.gyro[axis] = value(0, inertial_unit, 3 + k);
    }
    for (std::size_t side = 0; side < 2; ++side) {
      double counts = -options_.unloaded_counts[side], moment = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const double cell = value(1 + side, load_cells, k) - options_.unloaded_counts[side] / 4;
        counts += value(1 + side, load_cells, k);
        moment += cell * options_.cell_x[k];
      }
      reading.loads[side] = options_.newton_per_count * counts;
      if (reading.loads[side] > least_load_n) reading.pressure_x[side] = moment / counts;
    }
    return reading;
  }

 private:
  static constexpr std::size_t first_reading = 3;  // among the registers
  static constexpr double least_load_n = 1;        // on a foot: below it there is no centre of pressure [N]

  SensorBus* bus_;
  BusSensorsOptions options_;
};

}  // namespace dynamixel

// The body's sensors of a robot, as the command line of surefoot-walk names them: none, a pipe, or a port of their own.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "../balance/body_source.hpp"
#include "../balance/bus_sensors.hpp"
#include "../bus/background_port.hpp"
#include "../bus/bus.hpp"
#include "../bus/serial_port.hpp"

namespace sigmaban {

struct RobotBodyOptions {
  std::string from;  // file or pipe of readings
  std::string port;  // of an inertial unit and two feet, Protocol 1.0
  std::uint32_t bits_per_s = 1'000'000;
  dynamixel::BusSensorsOptions devices{};
};

/// A BodySource.
class RobotBody {
 public:
  /// Throws UsageError where the file, BusError where the port cannot be opened.
  explicit RobotBody(const RobotBodyOptions& options) {
    if (!options.from.empty()) reader_ = std::make_unique<BodyReader>(options.from);
    if (!options.port.empty()) devices_ = std::make_unique<Devices>(options);
  }

  std::optional<BodyReading> feel() {
    if (devices_) return devices_->sensors.feel();
    return reader_ ? reader_->feel() : std::nullopt;
  }
  bool any() const { return reader_ || devices_; }

 private:
  using Bus = dynamixel::Bus<dynamixel::Protocol1, dynamixel::BackgroundPort<dynamixel::SerialPort>>;
  struct Devices {
    explicit Devices(const RobotBodyOptions& options)
        : bus(dynamixel::BackgroundPort(dynamixel::SerialPort(options.port, options.bits_per_s)),
              {.return_delay_s = 500e-6, .latency_s = 1e-3}),
          sensors(bus, options.devices) {}
    Bus bus;
    dynamixel::BusSensors<Bus> sensors;
  };

  std::unique_ptr<BodyReader> reader_;
  std::unique_ptr<Devices> devices_;
};

static_assert(BodySource<RobotBody>);

}  // namespace sigmaban

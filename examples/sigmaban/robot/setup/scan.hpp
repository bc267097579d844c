// Who is on a line: every port, speed and protocol tried, by the broadcast ping where the protocol has one.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "../bus/bus.hpp"
#include "../bus/serial_port.hpp"
#include "../dynamixel/servo_models.hpp"

namespace dynamixel {

struct FoundServo {
  std::string port = {};
  std::uint32_t bits_per_s = 0;
  int protocol = 0;
  std::uint8_t id = 0;
  std::uint16_t model_number = 0;
  int firmware = 0;
};

struct ScanOptions {
  std::vector<std::uint32_t> bits_per_s{57'600, 1'000'000, 2'000'000, 3'000'000, 4'000'000, 115'200, 4'500'000, 9'600};
  std::vector<int> protocols{2, 1};
  /// After a broadcast ping, until the servo with the largest id must have answered: ROBOTIS' own software waits 3 ms
  /// for each id, and a servo with that id answers in its turn [s].
  double broadcast_s = 0.77;
  int broadcasts = 2;           // answers may be lost
  double latency_s = 0.02;      // of a single answer: adapters hand bytes on every 16 ms at worst [s]
  std::uint8_t last_id_1 = 30;  // of Protocol 1.0, where each id is asked by itself
};

/// Adapters that are plugged in, by name.
inline std::vector<std::string> serial_ports(const std::filesystem::path& folder = "/dev") {
  std::vector<std::string> ports;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("ttyUSB") || name.starts_with("ttyACM") || name.starts_with("ttyAMA")) {
      ports.push_back(entry.path());
    }
  }
  std::ranges::sort(ports);
  return ports;
}

/// Adds whoever answers a broadcast ping of Protocol 2.0 and is not there yet.
template <Transport Port>
void broadcast_ping(Port& port, double wait_s, std::vector<FoundServo>& found) {
  std::array<std::uint8_t, 64> packet{};
  std::array<std::uint8_t, 512> bytes{};
  protocol2::Decoder<> decoder;
  const Time end = port.now() + from_seconds(wait_s);
  port.write(protocol2::ping(packet, broadcast_id), end);
  while (const std::size_t count = port.read(bytes, end)) {
    for (const std::uint8_t byte : Bytes(bytes).first(count)) {
      decoder.push(byte);
      while (const auto received = decoder.next()) {
        const auto status = protocol2::as_status(*received);
        if (!status || status->data.size() != Protocol2::ping_answer) continue;
        const auto number = static_cast<std::uint16_t>(status->data[0] + 256 * status->data[1]);
        if (std::ranges::find(found, status->id, &FoundServo::id) != found.end()) continue;
        found.push_back({.id = status->id, .model_number = number, .firmware = status->data[2]});
      }
    }
  }
}

/// Asks each id by itself.
template <class ServoBus>
void ping_each(ServoBus& bus, std::uint8_t last_id, std::vector<FoundServo>& found) {
  for (int id = 0; id <= last_id; ++id) {
    const auto servo = static_cast<std::uint8_t>(id);
    std::array<std::uint8_t, 3> head{};  // model number and firmware of Protocol 1.0
    if (!bus.ping(servo) || !bus.read(servo, 0, head)) continue;
    const auto number = static_cast<std::uint16_t>(head[0] + 256 * head[1]);
    found.push_back({.id = servo, .model_number = number, .firmware = head[2]});
  }
}

/// At one speed, by one protocol. Throws BusError where the port cannot be used.
inline std::vector<FoundServo> scan_line(const std::string& path, std::uint32_t bits_per_s, int protocol,
                                         const ScanOptions& options) {
  std::vector<FoundServo> found;
  SerialPort port(path, bits_per_s);
  if (protocol == 2) {
    for (int i = 0; i < options.broadcasts; ++i) broadcast_ping(port, options.broadcast_s, found);
  } else {
    Bus<Protocol1, SerialPort> bus(std::move(port),
                                   {.latency_s = options.latency_s, .memory_s = 1e-3, .retries = 0, .table_end = 1});
    ping_each(bus, options.last_id_1, found);
  }
  std::ranges::sort(found, {}, &FoundServo::id);
  for (FoundServo& servo : found) {
    servo.port = path;
    servo.bits_per_s = bits_per_s;
    servo.protocol = protocol;
  }
  return found;
}

}  // namespace dynamixel

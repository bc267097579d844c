// A serial line as those who set servos up use it: patient, and by either protocol.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "../bus/bus.hpp"
#include "../bus/serial_port.hpp"
#include "scan.hpp"

namespace dynamixel {

/// Where the servos are.
struct ServoLine {
  std::string port;
  std::uint32_t bits_per_s = 1'000'000;
  int protocol = 2;
};

template <class Protocol>
using PatientBus = Bus<Protocol, SerialPort>;

/// Waits for the slowest servo behind the slowest adapter, and believes no answer that a computer's pause made late.
template <class Protocol>
PatientBus<Protocol> open_patiently(const std::string& port, std::uint32_t bits_per_s) {
  return PatientBus<Protocol>(SerialPort(port, bits_per_s),
                              {.return_delay_s = 508e-6, .latency_s = 0.02, .memory_s = 0.5, .retries = 2});
}

/// Calls work(Protocol()) with the protocol of that number.
template <class Work>
void with_protocol(int protocol, Work work) {
  if (protocol == 1) return work(Protocol1());
  work(Protocol2());
}

/// `given`, or all that a scan of the line finds. Throws BusError where nobody is there.
inline std::vector<std::uint8_t> ids_on(const ServoLine& line, std::vector<std::uint8_t> given) {
  if (!given.empty()) return given;
  for (const FoundServo& servo : scan_line(line.port, line.bits_per_s, line.protocol, {})) given.push_back(servo.id);
  if (given.empty()) {
    throw BusError(line.port + ": no servo answers at " + std::to_string(line.bits_per_s) + " bit/s by Protocol " +
                   std::to_string(line.protocol) + "; surefoot-servos scan tries all speeds. Is their power on?");
  }
  return given;
}

}  // namespace dynamixel

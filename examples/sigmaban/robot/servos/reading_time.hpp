// The time that reading all servos takes on the line.
#pragma once

#include <cstddef>
#include <cstdint>

#include "../bus/transport.hpp"

namespace dynamixel {

/// Of one instruction to `servos` and the answers of all, with `count` bytes each; without the adapter and the
/// operating system. Bytes that a bus asks for beyond those wanted, to know its answers apart, count with their mean.
template <class Protocol>
constexpr Time reading_time(std::size_t servos, std::size_t count, double return_delay_s, std::uint32_t bits_per_s) {
  constexpr std::size_t instruction_overhead = 14, per_servo = Protocol::version == 1 ? 3 : 1, mean_more = 5;
  const Time question = line_time(instruction_overhead + per_servo * servos, bits_per_s);
  const Time answer =
      from_seconds(return_delay_s) + line_time(Protocol::status_overhead + count + mean_more, bits_per_s);
  return question + answer * static_cast<int>(servos);
}

}  // namespace dynamixel

// How patient a bus is, and what it says of asking one servo.
#pragma once

#include <cstdint>

#include "round.hpp"

namespace dynamixel {

struct BusOptions {
  double return_delay_s = 500e-6;  // the longest Return Delay Time among the servos; 500 us when they are new [s]
  double latency_s = 1e-3;         // of the adapter and the operating system; 1 ms is a frame of USB [s]
  double memory_s = 20e-3;         // an answer comes no later than this after it was given up [s]
  int retries = 1;                 // per servo and call; none where the last two calls were in vain
  Chain chain = Chain::stops;
  bool echo = false;            // the adapter hands back what is sent; needed for Protocol 1.0 alone
  bool fast_sync_read = false;  // of Protocol 2.0: new firmware answers it; what it does not bring is asked as usual
  std::uint16_t table_end = 0;  // address behind the last byte that may be read; 0: that of MX servos
};

/// Of asking one servo.
struct Reply {
  Outcome outcome = Outcome::skipped;
  std::uint8_t error_bits = 0;  // as the protocol has them

  explicit operator bool() const { return outcome == Outcome::answered; }
};

}  // namespace dynamixel

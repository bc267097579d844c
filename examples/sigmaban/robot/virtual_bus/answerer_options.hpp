// How virtual servos answer, and what is kept of their answers for those who check.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "../bus/round.hpp"
#include "faults.hpp"

namespace dynamixel {

struct AnswererOptions {
  std::uint32_t bits_per_s = 3'000'000;
  Chain chain = Chain::stops;
  double chain_patience_s = 300e-6;  // after which a chain that goes on does so [s]
  double latency_timer_s = 0;        // of the adapter: what it received is handed over each time it runs out [s]
  Faults faults{};
  std::uint64_t seed = 1;
  bool knows_fast_reads = true;  // of Protocol 2.0, which older firmware does not
  bool own_speeds = false;       // each servo hears and answers only at the speed of its own Baud Rate
};

/// One answer that a servo gave, before any fault.
struct GivenAnswer {
  std::uint64_t instruction = 0;  // number of the instruction it answers, from 1
  std::size_t size = 0;
  std::array<std::uint8_t, 160> data{};
};

}  // namespace dynamixel

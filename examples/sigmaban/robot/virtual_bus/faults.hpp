// What may happen to the answers of servos on their way, drawn by chance and counted.
#pragma once

#include <cstdint>
#include <utility>

#include "../bus/transport.hpp"
#include "../dynamixel/packet.hpp"
#include "surefoot/core/rng.hpp"

namespace dynamixel {

/// Probabilities per answer; their sum is at most 1. An answer has at most one fault.
struct Faults {
  double lost = 0;          // the servo never sends it; the chain behind it stops
  double corrupted = 0;     // damaged between the line and the host: the other servos hear it right
  double late = 0;          // sent too late; the chain behind it stops
  double duplicated = 0;    // the host gets it twice, one after the other
  double wrong_id = 0;      // sent under the id of another servo of the bus
  double unheard = 0;       // share of instructions that no servo hears, whatever becomes of answers
  double late_s = 0.012;    // how much later [s]
  int corrupted_bytes = 2;  // of an answer, at most, one after the other. A CRC-16 finds all damage to two, but only
                            // 65,535 of 65,536 damages to more; the sum of Protocol 1.0 all damage to one
};

struct FaultCounts {
  std::uint64_t lost = 0;
  std::uint64_t corrupted = 0;
  std::uint64_t late = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t wrong_id = 0;
  std::uint64_t silent = 0;    // not sent, because the servo was told to be silent
  std::uint64_t withheld = 0;  // not sent, because a servo before it in the chain sent nothing in its turn

  FaultCounts& operator+=(const FaultCounts& other) {
    lost += other.lost;
    corrupted += other.corrupted;
    late += other.late;
    duplicated += other.duplicated;
    wrong_id += other.wrong_id;
    silent += other.silent;
    withheld += other.withheld;
    return *this;
  }
};

enum class Fault : std::uint8_t { none, lost, corrupted, late, duplicated, wrong_id };

inline Fault draw_fault(const Faults& faults, surefoot::Rng& rng) {
  const std::pair<double, Fault> shares[] = {{faults.lost, Fault::lost},
                                             {faults.corrupted, Fault::corrupted},
                                             {faults.late, Fault::late},
                                             {faults.duplicated, Fault::duplicated},
                                             {faults.wrong_id, Fault::wrong_id}};
  double left = rng.uniform();
  for (const auto& [share, fault] : shares) {
    left -= share;
    if (left < 0) return fault;
  }
  return Fault::none;
}

/// Replaces one to `most` bytes in a row by others.
inline void corrupt(Buffer packet, int most, surefoot::Rng& rng) {
  const std::uint32_t count = 1 + rng.below(static_cast<std::uint32_t>(most));
  const std::uint32_t first = rng.below(static_cast<std::uint32_t>(packet.size()) - count + 1);
  for (std::uint8_t& byte : packet.subspan(first, count)) {
    byte = static_cast<std::uint8_t>(byte ^ (1 + rng.below(255)));
  }
}

}  // namespace dynamixel

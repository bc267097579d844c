// What a bus knows about its servos' answers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "transport.hpp"

namespace dynamixel {

/// Of one servo. Each time it is asked ends as one of answered ... refused.
struct ServoStatistics {
  std::uint64_t asked = 0;
  std::uint64_t answered = 0;
  std::uint64_t lost = 0;          // nothing came, to this day
  std::uint64_t corrupted = 0;     // bytes came, but no packet
  std::uint64_t late = 0;          // came after it was given up, and was not used
  std::uint64_t skipped = 0;       // its turn never came, because a servo before it was silent or time ran out
  std::uint64_t wrong_id = 0;      // another's id came in its turn
  std::uint64_t wrong_length = 0;  // not as many bytes as asked for
  std::uint64_t refused = 0;       // the servo did not do it, and said so

  std::uint64_t duplicates = 0;          // answers that came again
  std::uint64_t errors = 0;              // answers with error bits
  std::uint8_t error_bits = 0;           // all that ever came, as the protocol has them
  std::uint8_t last_error_bits = 0;      // of the last answer
  std::uint64_t consecutive_misses = 0;  // calls without an answer, retries included
  std::uint64_t consecutive_losses = 0;  // of them, those in which its turn came
  Time last_answer = Time::min();

  double lowest_v = std::numeric_limits<double>::infinity();  // as far as anyone noted them [V]
  double highest_v = -std::numeric_limits<double>::infinity();
  double lowest_celsius = std::numeric_limits<double>::infinity();
  double highest_celsius = -std::numeric_limits<double>::infinity();
};

inline void note_voltage(ServoStatistics& statistics, double volts) {
  statistics.lowest_v = std::min(statistics.lowest_v, volts);
  statistics.highest_v = std::max(statistics.highest_v, volts);
}
inline void note_temperature(ServoStatistics& statistics, double celsius) {
  statistics.lowest_celsius = std::min(statistics.lowest_celsius, celsius);
  statistics.highest_celsius = std::max(statistics.highest_celsius, celsius);
}

/// Of the line as a whole.
struct LineStatistics {
  std::uint64_t instructions = 0;   // sent
  std::uint64_t dropped_bytes = 0;  // received that belong to no packet
  std::uint64_t echoes = 0;         // of what was sent
  std::uint64_t strangers = 0;      // status packets that nobody asked for
};

/// Adds the counts of one servo to those of many.
inline ServoStatistics& operator+=(ServoStatistics& sum, const ServoStatistics& more) {
  sum.asked += more.asked;
  sum.answered += more.answered;
  sum.lost += more.lost;
  sum.corrupted += more.corrupted;
  sum.late += more.late;
  sum.skipped += more.skipped;
  sum.wrong_id += more.wrong_id;
  sum.wrong_length += more.wrong_length;
  sum.refused += more.refused;
  sum.duplicates += more.duplicates;
  sum.errors += more.errors;
  sum.error_bits = static_cast<std::uint8_t>(sum.error_bits | more.error_bits);
  sum.last_answer = std::max(sum.last_answer, more.last_answer);
  sum.consecutive_misses = std::max(sum.consecutive_misses, more.consecutive_misses);
  sum.consecutive_losses = std::max(sum.consecutive_losses, more.consecutive_losses);
  sum.lowest_v = std::min(sum.lowest_v, more.lowest_v);
  sum.highest_v = std::max(sum.highest_v, more.highest_v);
  sum.lowest_celsius = std::min(sum.lowest_celsius, more.lowest_celsius);
  sum.highest_celsius = std::max(sum.highest_celsius, more.highest_celsius);
  return sum;
}

}  // namespace dynamixel

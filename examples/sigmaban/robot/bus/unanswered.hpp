// Answers that did not come in time and still may. A status packet does not say what it answers: only its id and its
// length tell. So whoever asks again must not ask for a length that is still out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "outcome.hpp"
#include "transport.hpp"

namespace dynamixel {

/// An answer that is out.
struct MissingAnswer {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::uint8_t id = 0;
  std::size_t length = none;  // bytes of data; none: not out any more
  Outcome held_for = Outcome::lost;
  Time until{};                   // it may come
  std::uint64_t instruction = 0;  // its number
  std::size_t turn = 0;           // in that instruction
  bool chain_went_on = false;     // it is held for silent because the one before it came late
};

/// The last eight of each id.
class Unanswered {
 public:
  void add(const MissingAnswer& missing) {
    MissingAnswer* place = &missing_[missing.id].front();
    for (MissingAnswer& each : missing_[missing.id]) {
      if (each.length == MissingAnswer::none || each.length == missing.length) {
        place = &each;
        break;
      }
      if (each.until < place->until) place = &each;
    }
    *place = missing;
  }

  bool may_come(std::uint8_t id, std::size_t length, Time now) const {
    for (const MissingAnswer& each : missing_[id]) {
      if (each.length == length && each.until > now) return true;
    }
    return false;
  }

  /// Null if none of that length is out.
  MissingAnswer* find(std::uint8_t id, std::size_t length) {
    for (MissingAnswer& each : missing_[id]) {
      if (each.length == length) return &each;
    }
    return nullptr;
  }

  /// The first in turn from `turn` on of those that an instruction misses and that are held for `outcome`; null if
  /// there is none.
  MissingAnswer* find(std::uint64_t instruction, Outcome outcome, std::size_t turn) {
    MissingAnswer* first = nullptr;
    for (auto& of_one : missing_) {
      for (MissingAnswer& each : of_one) {
        if (each.length == MissingAnswer::none || each.instruction != instruction) continue;
        if (each.held_for != outcome || each.turn < turn) continue;
        if (first == nullptr || each.turn < first->turn) first = &each;
      }
    }
    return first;
  }

 private:
  std::array<std::array<MissingAnswer, 8>, 256> missing_{};  // of each id
};

}  // namespace dynamixel

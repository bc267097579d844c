// Judges the answers to one instruction. Knows the order in which they must come, so that a servo that answers under
// another's id is not believed, and that it is known whose answer is missing.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "../dynamixel/crc16.hpp"
#include "outcome.hpp"
#include "protocols.hpp"

namespace dynamixel {

inline constexpr std::size_t max_servos = 64;  // asked by one instruction

/// What servos do in a sync or bulk read when the one before them is silent. ROBOTIS: none after it answers
/// (DynamixelSDK, issue 364). Firmware may also go on after a while; then answers may leave others out.
enum class Chain : std::uint8_t { stops, goes_on };

/// Servos in the order of their turns. Nothing is allocated.
class Round {
 public:
  /// `packet_overhead`: bytes of a status packet that carry no data. `older_out`: answers to older instructions may
  /// still come, so garbage may be one of them.
  Round(Chain chain, std::size_t packet_overhead, bool older_out = false)
      : chain_(chain), older_out_(older_out), packet_overhead_(packet_overhead) {}

  /// The next in turn, who answers with `length` bytes of data.
  void expect(std::uint8_t id, std::size_t length) { turns_[size_++] = {id, Outcome::skipped, false, length, 0}; }

  std::size_t size() const { return size_; }
  /// Turns without an answer.
  std::size_t open() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < size_; ++i) count += turns_[i].came ? 0 : 1;
    return count;
  }
  Outcome outcome(std::size_t turn) const { return turns_[turn].outcome; }
  std::size_t length(std::size_t turn) const { return turns_[turn].length; }
  bool came(std::size_t turn) const { return turns_[turn].came; }

  std::optional<std::size_t> turn_of(std::uint8_t id) const {
    for (std::size_t i = 0; i < size_; ++i) {
      if (turns_[i].id == id) return i;
    }
    return std::nullopt;
  }

  /// The same data as the answer that came in that turn.
  bool repeats(std::size_t turn, Bytes data) const { return turns_[turn].fingerprint == crc16(data); }

  /// Bytes that make no packet came before what comes next.
  void note_garbage(std::size_t bytes) { garbage_bytes_ += bytes; }
  /// What came before the first answer was not of this round after all. Returns how many bytes it was.
  std::size_t disown_garbage() { return next_ == 0 ? std::exchange(garbage_bytes_, 0) : 0; }
  /// An answer came under an id whose turn it is not.
  void note_wrong_id() { ++wrong_ids_; }

  /// May an answer come in that turn now? Turns are only left out where garbage or wrong ids came instead, one each.
  bool in_order(std::size_t turn) const {
    if (chain_ == Chain::goes_on) return true;
    return turn == next_ + garbage_packets() + wrong_ids_ || (older_out_ && wrong_ids_ == 0 && turn == next_);
  }

  /// Returns how many bytes of garbage came before it that stand for no turn.
  std::size_t settle(std::size_t turn, Outcome outcome, Bytes data) {
    turns_[turn].outcome = outcome;
    turns_[turn].came = true;
    turns_[turn].fingerprint = crc16(data);
    if (turn < next_) return 0;
    const std::size_t stray = turn == next_ ? garbage_bytes_ : 0;
    explain(next_, turn);
    next_ = turn + 1;
    return stray;
  }

  /// Nothing more comes: says of those who did not answer why.
  void finish() {
    std::size_t turn = explain(next_, size_);
    if (chain_ == Chain::stops) {  // one is silent, so those after it are
      for (; turn < size_; ++turn) turns_[turn].outcome = Outcome::skipped;
    }
    next_ = size_;
  }

 private:
  struct Turn {
    std::uint8_t id = 0;
    Outcome outcome = Outcome::skipped;
    bool came = false;
    std::size_t length = 0;
    std::uint16_t fingerprint = 0;
  };

  /// In packets of the size that is due, to the nearest: a few stray bytes are none.
  std::size_t garbage_packets() const {
    const std::size_t size = packet_overhead_ + turns_[std::min(next_, max_servos - 1)].length;
    return (garbage_bytes_ + size / 2) / size;
  }

  /// Gives garbage and wrong ids to turns from `begin` on, the rest to silence. Returns the turn behind the first that
  /// was silent.
  std::size_t explain(std::size_t begin, std::size_t end) {
    std::size_t corrupted = garbage_bytes_ > 0 ? std::max<std::size_t>(1, garbage_packets()) : 0, first_silent = end;
    for (std::size_t i = begin; i < end; ++i) {
      if (turns_[i].came) continue;
      if (corrupted > 0) {
        turns_[i].outcome = Outcome::corrupted;
        --corrupted;
      } else if (wrong_ids_ > 0) {
        turns_[i].outcome = Outcome::wrong_id;
        --wrong_ids_;
      } else {
        turns_[i].outcome = Outcome::lost;
        if (first_silent == end) first_silent = i;
      }
    }
    garbage_bytes_ = 0;
    wrong_ids_ = 0;
    return first_silent == end ? end : first_silent + 1;
  }

  Chain chain_;
  bool older_out_;
  std::size_t packet_overhead_;
  std::array<Turn, max_servos> turns_{};
  std::size_t size_ = 0;
  std::size_t next_ = 0;  // turns before it are over
  std::size_t garbage_bytes_ = 0;
  std::size_t wrong_ids_ = 0;
};

}  // namespace dynamixel

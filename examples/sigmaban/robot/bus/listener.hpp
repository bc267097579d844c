// Makes answers of bytes, decides which to believe, and keeps the counts. See bus.hpp for the rules.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "protocols.hpp"
#include "round.hpp"
#include "statistics.hpp"
#include "transport.hpp"
#include "unanswered.hpp"

namespace dynamixel {

/// Which counter an outcome belongs to.
inline std::uint64_t& count_of(ServoStatistics& servo, Outcome outcome) {
  switch (outcome) {
    case Outcome::answered:
      return servo.answered;
    case Outcome::refused:
      return servo.refused;
    case Outcome::lost:
      return servo.lost;
    case Outcome::corrupted:
      return servo.corrupted;
    case Outcome::wrong_id:
      return servo.wrong_id;
    case Outcome::wrong_length:
      return servo.wrong_length;
    case Outcome::skipped:
      break;
  }
  return servo.skipped;
}

/// Listens for one round of answers after the other; between rounds everything that comes is old. Has no clock and no
/// port: it is told the time and the bytes. Nothing is allocated.
template <class Protocol>
class Listener {
 public:
  /// `echo`: what is sent comes back, which Protocol 1.0 needs to be told.
  Listener(Chain chain, bool echo) : chain_(chain), echo_(echo) { last_length_.fill(MissingAnswer::none); }

  /// No answers are expected.
  void end_round() { round_ = Round(chain_, Protocol::status_overhead); }
  /// Answers are expected from those whose turns are then added to round().
  void begin_round(Time now) { round_ = Round(chain_, Protocol::status_overhead, older_out(now)); }

  /// Nothing more comes in this round. A packet that has begun may yet end.
  void finish_round() {
    note_garbage();
    round_.finish();
  }

  Round& round() { return round_; }
  const Round& round() const { return round_; }

  /// An instruction was sent. `packet` must stay until the next one.
  void note_sent(Bytes packet) {
    sent_ = packet;
    if constexpr (Protocol::version == 2) {
      constexpr std::size_t code = 7;  // its place in a packet
      in_blocks_ = packet.size() > code && packet[code] == static_cast<std::uint8_t>(Instruction::fast_sync_read);
      decoder_.set_longest(in_blocks_ ? longest_packet : longest_status);
    }
    ++line_.instructions;
  }

  /// accept(turn, data) is called for each answer to be believed.
  template <class Accept>
  void take(Bytes bytes, Time now, Accept accept) {
    now_ = now;
    for (const std::uint8_t byte : bytes) {
      decoder_.push(byte);
      take_packets(accept);
    }
  }

  /// The line is silent, so a packet that has begun never ends. True if there was one: whole ones may be in it.
  template <class Accept>
  bool give_up(Time now, Accept accept) {
    now_ = now;
    const bool begun = decoder_.pending() > 0;
    if (begun) decoder_.give_up();
    take_packets(accept);
    note_garbage();
    return begun;
  }

  /// Counts how a turn of the round ended. Its answer may come until `until`, if it did not.
  void count(std::size_t turn, std::uint8_t id, Time now, Time until) {
    const Outcome outcome = round_.outcome(turn);
    ServoStatistics& servo = servos_[id];
    ++servo.asked;
    ++count_of(servo, outcome);
    if (outcome == Outcome::answered) {
      servo.last_answer = now;
      last_length_[id] = round_.length(turn);
    } else if (outcome != Outcome::refused) {
      unanswered_.add({id, round_.length(turn), outcome, until, line_.instructions, turn});
      older_until_ = until;
    }
  }

  /// May any older answer come?
  bool older_out(Time now) const { return now < older_until_; }

  /// May an older answer with `length` bytes of data come from that servo?
  bool may_come(std::uint8_t id, std::size_t length, Time now) const { return unanswered_.may_come(id, length, now); }

  ServoStatistics& statistics(std::uint8_t id) { return servos_[id]; }
  const ServoStatistics& statistics(std::uint8_t id) const { return servos_[id]; }
  const LineStatistics& line() const { return line_; }

 private:
  static constexpr std::size_t longest_status = 256;                                  // [bytes]
  static constexpr std::size_t longest_packet = Protocol::version == 2 ? 2048 : 256;  // the answer of many at once

  template <class Accept>
  void take_packets(Accept accept) {
    while (const auto packet = decoder_.next()) {
      note_garbage();
      if constexpr (Protocol::version == 2) {
        if (packet->id == broadcast_id && static_cast<Instruction>(packet->code) == Instruction::status) {
          judge_blocks(packet->parameters, accept);
          continue;
        }
      }
      const auto status = Protocol::as_status(*packet);
      if (!status || (echo_ && is_echo(*packet))) {
        ++line_.echoes;
      } else {
        judge(*status, accept);
      }
    }
  }

  bool is_echo(const Packet& packet) {
    constexpr std::size_t head = 5;  // of Protocol 1.0
    if (sent_.size() != packet.parameters.size() + head + 1) return false;
    const bool same = sent_[2] == packet.id && sent_[4] == packet.code &&
                      std::equal(packet.parameters.begin(), packet.parameters.end(), sent_.begin() + head);
    if (same) sent_ = {};  // it comes once
    return same;
  }

  /// The answers of all to a fast sync read, in turn. An older one has other lengths.
  template <class Accept>
  void judge_blocks(Bytes rest, Accept accept) {
    constexpr std::size_t overhead = Protocol::block_overhead, head = 2, last_crc = 2;
    std::size_t size = 0;
    for (std::size_t i = 0; i < round_.size(); ++i) size += overhead + round_.length(i);
    if (!in_blocks_ || size != rest.size() + last_crc) {
      ++line_.strangers;
      return;
    }
    for (std::size_t i = 0; i < round_.size(); ++i) {
      const std::size_t length = round_.length(i);
      if (round_.turn_of(rest[1]) != i) return note_wrong_id();
      judge({rest[1], rest[0], (rest[0] & ~protocol2::alert_bit) != 0, rest.subspan(head, length)}, accept);
      rest = rest.subspan(std::min(rest.size(), length + overhead));
    }
  }

  template <class Accept>
  void judge(const Status& status, Accept accept) {
    const auto turn = round_.turn_of(status.id);
    ServoStatistics& servo = servos_[status.id];
    if (turn && round_.came(*turn)) {
      if (round_.repeats(*turn, status.data)) {
        ++servo.duplicates;
      } else if (status.data.size() == round_.length(*turn) || !is_old(status)) {
        note_wrong_id();
      }
      return;
    }
    const bool fits = turn && (status.data.size() == round_.length(*turn) || status.refused);
    if (!fits && is_old(status)) return;
    if (!turn || !round_.in_order(*turn)) return note_wrong_id();
    const Outcome outcome = !fits ? Outcome::wrong_length : status.refused ? Outcome::refused : Outcome::answered;
    note_late_garbage(round_.settle(*turn, outcome, status.data));
    if (outcome == Outcome::wrong_length) return;
    servo.last_error_bits = status.error_bits;
    servo.error_bits = static_cast<std::uint8_t>(servo.error_bits | status.error_bits);
    servo.errors += status.error_bits != 0 ? 1 : 0;
    if (outcome == Outcome::answered) accept(*turn, status.data);
  }

  /// An answer to an older instruction: late, or one that came twice.
  bool is_old(const Status& status) {
    ServoStatistics& servo = servos_[status.id];
    if (MissingAnswer* missing = unanswered_.find(status.id, status.data.size())) {
      note_late_garbage(round_.disown_garbage());  // answers come in the order of the instructions
      older_ = missing->instruction;
      came_late(*missing, servo.late);
      return true;
    }
    if (last_length_[status.id] != status.data.size()) return false;
    ++servo.duplicates;
    return true;
  }

  /// What was missing came after all, and is now counted in `counter`. If its turn came after one that was held for
  /// silent, the chain went on, and the silent one is further behind.
  void came_late(MissingAnswer& missing, std::uint64_t& counter) {
    --count_of(servos_[missing.id], missing.held_for);
    ++counter;
    missing.length = MissingAnswer::none;
    if (chain_ != Chain::stops || (missing.held_for != Outcome::skipped && !missing.chain_went_on)) return;
    if (MissingAnswer* next = unanswered_.find(missing.instruction, Outcome::skipped, missing.turn)) {
      next->held_for = Outcome::lost;
      next->chain_went_on = true;
      --servos_[next->id].skipped;
      ++servos_[next->id].lost;
    }
  }

  void note_wrong_id() {
    ++line_.strangers;
    round_.note_wrong_id();
  }

  /// Books the bytes that the decoder dropped since the last call.
  void note_garbage() {
    const std::uint64_t dropped = decoder_.statistics().dropped_bytes;
    const auto bytes = static_cast<std::size_t>(dropped - line_.dropped_bytes);
    line_.dropped_bytes = dropped;
    if (round_.size() == 0) {
      note_late_garbage(bytes);
    } else {
      round_.note_garbage(bytes);
    }
  }

  /// Late bytes that make no packet are the answer of one that is held for silent: of the older instructions, in the
  /// order in which they come, the first with an answer of that size; else of the newest with any.
  void note_late_garbage(std::size_t bytes) {
    constexpr std::uint64_t instructions = 4;  // that far back
    if (bytes < Protocol::status_overhead / 2) return;
    const std::uint64_t last = line_.instructions, first = std::max(older_, last - std::min(last, instructions) + 1);
    MissingAnswer* its = nullptr;
    for (std::uint64_t each = last; each >= first && each > 0; --each) {
      MissingAnswer* silent = unanswered_.find(each, Outcome::lost, 0);
      if (silent == nullptr || silent->until < now_) continue;
      if (its == nullptr || silent->length + Protocol::status_overhead == bytes) its = silent;
    }
    if (its != nullptr) came_late(*its, servos_[its->id].corrupted);
  }

  Chain chain_;
  bool echo_;
  bool in_blocks_ = false;  // the last instruction was a fast sync read
  typename Protocol::template Decoder<longest_packet> decoder_;
  Round round_{Chain::stops, 0};
  Unanswered unanswered_;
  std::array<ServoStatistics, 256> servos_{};
  std::array<std::size_t, 256> last_length_{};  // of the last answer [bytes of data]
  LineStatistics line_;
  Bytes sent_;  // the last instruction
  Time now_{};
  Time older_until_{};       // answers to older instructions may come
  std::uint64_t older_ = 0;  // the instruction of the last of them that came
};

}  // namespace dynamixel

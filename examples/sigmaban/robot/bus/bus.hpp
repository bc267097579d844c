// Servos on one serial line.
//
// Whom to believe. Whatever was received before an instruction is sent belongs to an older one and is thrown away. An
// answer counts only with a right check sum, the id whose turn it is and the length asked for. (One under another's id
// passes only where a second fault in the same round makes room for it.) An older answer may yet come while a newer one
// is waited for, and nothing in it says so; therefore reads ask for up to nine bytes more, no two in a row as many, and
// a length that is still out is not asked for again before its time has passed.
//
// What a check sum is worth. The CRC-16 of Protocol 2.0 finds all damage to two bytes in a row (16 bits in its order,
// which is not that of the line: nine bits in a row on the line are safe), to any two bits and to any odd number of
// bits; of other damage it lets one in 65,536 pass. The sum of Protocol 1.0 finds all damage to one byte; of other
// damage it lets one in 256 pass.
//
// When to go on. A round of answers is over when all have answered or the line has been silent for longer than a servo
// may take. Those not heard are asked again at once, within the caller's deadline and number of retries: first those
// whose turn never came, because a servo before them was silent. Servos that were silent in the last calls are asked
// last, those that had no answer for another reason first.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "bus_options.hpp"
#include "listener.hpp"
#include "protocols.hpp"
#include "transport.hpp"

namespace dynamixel {

/// A deadline limits when the last byte of an answer may come; by default retries limit it alone. Nothing is allocated
/// in any call. Arguments that no packet can carry throw BusError. For one thread. About 100 kB.
template <class Protocol, Transport Port>
class Bus {
 public:
  using Wire = Protocol;
  static constexpr std::size_t max_data = 128;  // from one servo [bytes]

  explicit Bus(Port port, BusOptions options = {})
      : port_(std::move(port)),
        options_(options),
        bits_per_s_(port_.bits_per_s()),
        listener_(options.chain, options.echo) {
    if (options_.table_end == 0) options_.table_end = Protocol::table_end;
  }

  Reply ping(std::uint8_t id) {
    return ask_one(id, Protocol::ping_answer, [&] { return Protocol::ping(packet_, id); });
  }

  /// out.size() bytes from `address` on; untouched if there is no answer.
  Reply read(std::uint8_t id, std::uint16_t address, Buffer out, Time deadline = Time::max()) {
    const BulkItem item{id, address, static_cast<std::uint16_t>(out.size())};
    Outcome outcome{};
    ask_for(std::span(&item, 1), out, std::span(&outcome, 1), deadline,
            [&](std::span<const BulkItem> items) { return Protocol::read_one(packet_, items.front()); });
    return {outcome, listener_.statistics(id).last_error_bits};
  }

  Reply write(std::uint8_t id, std::uint16_t address, Bytes data) {
    return ask_one(id, 0, [&] { return Protocol::write(packet_, id, address, data, Instruction::write); });
  }

  /// A write that waits for an action.
  Reply reg_write(std::uint8_t id, std::uint16_t address, Bytes data) {
    return ask_one(id, 0, [&] { return Protocol::write(packet_, id, address, data, Instruction::reg_write); });
  }

  /// After its answer the servo starts anew: without torque and errors, its RAM as from the factory.
  Reply reboot(std::uint8_t id) {
    return ask_one(id, 0, [&] { return Protocol::reboot(packet_, id); });
  }

  /// To all. None answers.
  void action() { send(Protocol::action(packet_)); }

  /// data.size() / ids.size() bytes to each, in their order. None answers.
  void sync_write(std::uint16_t address, Bytes ids, Bytes data) {
    if (ids.empty()) return;
    send(Protocol::sync_write(packet_, address, static_cast<std::uint16_t>(data.size() / ids.size()), ids, data));
  }

  /// To each servo its own registers: `data` holds the bytes of all items, one after the other. None answers. Protocol
  /// 2.0 alone.
  void bulk_write(std::span<const BulkItem> items, Bytes data) requires requires(Buffer out) {
    Protocol::bulk_write(out, items, data);
  }
  {
    if (!items.empty()) send(Protocol::bulk_write(packet_, items, data));
  }

  /// The same bytes of each servo: `out` holds them in the order of `ids`, untouched where `outcomes` are not
  /// `answered`. Returns how many answered. In Protocol 1.0 this is a bulk read.
  std::size_t sync_read(std::uint16_t address, std::uint16_t count, Bytes ids, Buffer out, std::span<Outcome> outcomes,
                        Time deadline = Time::max()) {
    check(ids.size() <= max_servos, "asks too many servos at once, the most are 64");
    std::array<BulkItem, max_servos> items;
    for (std::size_t i = 0; i < ids.size(); ++i) items[i] = {ids[i], address, count};
    fast_ = Protocol::version == 2 && options_.fast_sync_read;
    return bulk_read(std::span(items).first(ids.size()), out, outcomes, deadline);
  }

  /// Of each servo its own bytes, one after the other.
  std::size_t bulk_read(std::span<const BulkItem> items, Buffer out, std::span<Outcome> outcomes,
                        Time deadline = Time::max()) {
    return ask_for(items, out, outcomes, deadline, [&](std::span<const BulkItem> now) {
      if constexpr (Protocol::version == 2) return Protocol::read_many(packet_, now, fast_round_);
      return Protocol::read_many(packet_, now);
    });
  }

  /// Counts of one servo.
  const ServoStatistics& statistics(std::uint8_t id) const { return listener_.statistics(id); }
  ServoStatistics& statistics(std::uint8_t id) { return listener_.statistics(id); }
  const LineStatistics& line() const { return listener_.line(); }

  /// Looks at what came since the last answer, so that the counts are up to date.
  void listen() { drain(0); }

  Port& port() { return port_; }
  const Port& port() const { return port_; }
  const BusOptions& options() const { return options_; }
  /// From now on answers are waited for that long [s], apart from the line's own time.
  void set_patience(double return_delay_s, double latency_s) {
    options_.return_delay_s = return_delay_s;
    options_.latency_s = latency_s;
  }

  /// Address behind the last byte that may be read from now on, of servos of another model.
  void set_table_end(std::uint16_t address) { options_.table_end = address; }

 private:
  static constexpr std::size_t marks = 10;      // lengths that reads take turns with
  static constexpr std::size_t fast_marks = 3;  // a packet of all that is late by so many cycles is not out any more

  struct Question {
    BulkItem item;
    std::size_t index = 0;   // among the caller's
    std::size_t offset = 0;  // in the caller's buffer
    int attempts = 0;
  };

  static void check(bool right, const char* what) {
    if (!right) throw BusError(std::string("bus: an instruction ") + what);
  }

  /// An exchange with one servo that cannot be told apart by its length.
  template <class Encode>
  Reply ask_one(std::uint8_t id, std::size_t length, Encode encode) {
    check(id <= Protocol::max_id, "asks an id that no servo has, the largest is 252 (Protocol 1.0: 253)");
    const BulkItem item{id, 0, static_cast<std::uint16_t>(length)};
    questions_[0] = {item, 0, 0, 0};
    Outcome outcome = Outcome::skipped;
    ask(1, 1, Time::max(), {}, std::span(&outcome, 1), [&](std::span<const BulkItem>) { return encode(); });
    note_call(id, outcome);
    return {outcome, listener_.statistics(id).last_error_bits};
  }

  template <class Encode>
  std::size_t ask_for(std::span<const BulkItem> items, Buffer out, std::span<Outcome> outcomes, Time deadline,
                      Encode encode) {
    check(items.size() <= max_servos, "asks too many servos at once, the most are 64");
    check(outcomes.size() == items.size(), "has not as many outcomes as servos to ask");
    std::size_t offset = 0, count = 0, kinds = marks;
    for (const int rank : {0, 1, 2, 3}) {
      offset = 0;
      for (std::size_t i = 0; i < items.size(); ++i) {
        const BulkItem& item = items[i];
        check(item.id <= Protocol::max_id, "asks an id that no servo has, the largest is 252 (Protocol 1.0: 253)");
        check(item.count > 0 && item.count <= max_data, "asks for no bytes or more than 128");
        if (std::size_t{item.address} + item.count + marks - 1 > options_.table_end) kinds = 1;
        if (rank_of(listener_.statistics(item.id)) == rank) questions_[count++] = {item, i, offset, 0};
        offset += item.count;
      }
    }
    check(offset == out.size(), "has a buffer of another size than the bytes it asks for");
    std::fill(outcomes.begin(), outcomes.end(), Outcome::skipped);
    ask(count, kinds, deadline, out, outcomes, encode);
    std::size_t answered = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      note_call(items[i].id, outcomes[i]);
      answered += outcomes[i] == Outcome::answered ? 1 : 0;
    }
    return answered;
  }

  /// First those without an answer in the last call, last those that were silent in more than two.
  static int rank_of(const ServoStatistics& servo) {
    if (servo.consecutive_losses > 2) return servo.consecutive_losses < 5 ? 2 : 3;
    return servo.consecutive_misses > 0 ? 0 : 1;
  }

  void note_call(std::uint8_t id, Outcome outcome) {
    ServoStatistics& servo = listener_.statistics(id);
    servo.consecutive_misses = outcome == Outcome::answered ? 0 : servo.consecutive_misses + 1;
    if (outcome == Outcome::answered) servo.consecutive_losses = 0;
    if (outcome != Outcome::answered && outcome != Outcome::skipped) ++servo.consecutive_losses;
  }

  /// Rounds until the first `count` of questions_ are settled.
  template <class Encode>
  void ask(std::size_t count, std::size_t kinds, Time deadline, Buffer out, std::span<Outcome> outcomes,
           Encode encode) {
    bool asked_any = false;
    while (count > 0) {
      drain(kinds == 1 ? options_.latency_s : 0);  // where it could not be told from one that comes twice
      const Time now = port_.now();
      fast_round_ =
          std::exchange(fast_, false) && kinds > 1;  // but once: what it does not bring is asked servo by servo
      mark_ = fast_round_ ? (mark_ + 1) % std::min(kinds, fast_marks) : next_mark(count, kinds, now);
      std::array<BulkItem, max_servos> items;
      std::array<std::size_t, max_servos> places;
      std::size_t asked = 0;
      for (std::size_t i = 0; i < count; ++i) {
        BulkItem item = questions_[i].item;
        item.count = static_cast<std::uint16_t>(item.count + mark_);
        if (!fast_round_ && listener_.may_come(item.id, item.count, now)) continue;
        items[asked] = item;
        places[asked++] = i;
      }
      if (asked == 0) {  // older answers are out and could not be told from what is asked now
        if ((asked_any && kinds > 1) || now >= deadline) return;
        receive(std::min(deadline, now + from_seconds(options_.memory_s / 8)), [](std::size_t, Bytes) {});
        continue;
      }
      const Bytes packet = encode(std::span<const BulkItem>(items).first(asked));
      check(!packet.empty(), "does not fit into a packet");
      std::size_t longest = 0;
      listener_.begin_round(now);
      for (std::size_t i = 0; i < asked; ++i) {
        listener_.round().expect(items[i].id, items[i].count);
        longest = std::max<std::size_t>(longest, items[i].count);
      }
      if (now + line_time(packet.size(), bits_per_s_) + quiet(longest) > deadline) return;
      asked_any = true;
      hear(packet, longest, deadline, [&](std::size_t turn, Bytes data) {
        const Question& q = questions_[places[turn]];
        std::copy_n(data.begin(), out.empty() ? 0 : q.item.count, out.begin() + static_cast<std::ptrdiff_t>(q.offset));
      });
      if (fast_round_ && listener_.round().open() == asked)
        continue;  // the packet of all did not come: as if not asked
      count = book(std::span(places).first(asked), count, outcomes);
    }
  }

  /// Books the round's outcomes; what is to be asked again stays in questions_. Returns how many.
  std::size_t book(std::span<const std::size_t> places, std::size_t count, std::span<Outcome> outcomes) {
    std::array<Question, max_servos> again;
    std::size_t stays = 0, repeated = 0, turn = 0;
    const Time now = port_.now(), until = now + from_seconds(options_.memory_s);
    for (std::size_t i = 0; i < count; ++i) {
      Question q = questions_[i];
      if (turn == places.size() || places[turn] != i) {  // was not asked
        questions_[stays++] = q;
        continue;
      }
      const Outcome outcome = listener_.round().outcome(turn);
      if (outcome != Outcome::skipped || q.attempts == 0) outcomes[q.index] = outcome;  // else what it was before
      listener_.count(turn++, q.item.id, now, until);
      if (outcome == Outcome::answered || outcome == Outcome::refused) continue;
      if (outcome == Outcome::skipped) {
        questions_[stays++] = q;
      } else if (q.attempts++ < options_.retries && listener_.statistics(q.item.id).consecutive_losses < 2) {
        again[repeated++] = q;
      }
    }
    std::copy_n(again.begin(), repeated, questions_.begin() + static_cast<std::ptrdiff_t>(stays));
    return stays + repeated;
  }

  /// Bytes to ask for beyond those wanted: the least that is out with no servo asked and was not asked for last, so
  /// that an answer that comes twice is known; else that which is out with the fewest, those who have waited counting
  /// more.
  std::size_t next_mark(std::size_t count, std::size_t kinds, Time now) const {
    std::size_t best = mark_ % kinds;
    std::uint64_t fewest = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t mark = 0; mark < kinds; ++mark) {
      if (mark == mark_ && kinds > 1) continue;
      std::uint64_t out = 0;
      for (std::size_t j = 0; j < count; ++j) {
        const BulkItem& item = questions_[j].item;
        if (listener_.may_come(item.id, item.count + mark, now)) {
          out += 1 + listener_.statistics(item.id).consecutive_misses;
        }
      }
      if (out < fewest) best = mark, fewest = out;
    }
    return best;
  }

  /// The longest silence before an answer of that length is complete.
  Time quiet(std::size_t length) const {
    const std::size_t bytes = Protocol::status_overhead + length + length / 3;  // with stuffing
    return from_seconds(options_.return_delay_s + options_.latency_s) + line_time(bytes, bits_per_s_);
  }

  void send(Bytes packet) {
    check(!packet.empty(), "does not fit into a packet, or its data are not of one size per servo");
    const Time now = port_.now(), time = line_time(packet.size(), bits_per_s_);
    port_.write(packet, now + time + from_seconds(0.1));
    line_free_ = std::max(now, line_free_) + time;
    listener_.note_sent(packet);
  }

  /// One round: sends and listens until all have answered, the line has been silent for long, or time is over.
  template <class Accept>
  void hear(Bytes packet, std::size_t length, Time deadline, Accept accept) {
    send(packet);
    const Time silence = quiet(length);
    const Time end = std::min(deadline, line_free_ + silence * static_cast<int>(listener_.round().size() + 1));
    Time last = line_free_;
    while (listener_.round().open() > 0) {
      const bool over = port_.now() >= end;  // still, what is there by now is taken
      if (receive(std::min(last + silence, end), accept)) {
        last = std::max(last, port_.now());
      } else if (port_.now() >= end || !listener_.give_up(port_.now(), accept)) {
        break;
      }
      if (over) break;
    }
    listener_.finish_round();
  }

  /// What came before an instruction is sent answers an older one. Waits until the line has been silent that long [s].
  void drain(double silence_s) {
    const auto ignore = [](std::size_t, Bytes) {};
    listener_.end_round();
    for (int reads = 0; reads < 64; ++reads) {  // of a line that babbles on
      if (!receive(port_.now() + from_seconds(silence_s), ignore)) break;
    }
    if (silence_s <= 0 && listener_.older_out(port_.now())) return;  // the rest of a late packet may be under way
    while (listener_.give_up(port_.now(), ignore)) {
    }
  }

  template <class Accept>
  bool receive(Time deadline, Accept accept) {
    const std::size_t count = port_.read(received_, deadline);
    listener_.take(Bytes(received_).first(count), port_.now(), accept);
    return count > 0;
  }

  Port port_;
  BusOptions options_;
  std::uint32_t bits_per_s_;
  Listener<Protocol> listener_;
  std::array<Question, max_servos> questions_{};
  std::array<std::uint8_t, 1024> packet_{};
  std::array<std::uint8_t, 1024> received_{};
  Time line_free_{};  // when the last byte sent is on the line
  std::size_t mark_ = 0;
  bool fast_ = false, fast_round_ = false;  // the next read, the present round is a fast sync read
};

}  // namespace dynamixel

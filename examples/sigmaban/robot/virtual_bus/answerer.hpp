// Servos as seen from the line: bytes in, bytes out, each with the moment it is due. Knows nothing of ports or threads.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "../bus/protocols.hpp"
#include "../bus/transport.hpp"
#include "answerer_options.hpp"
#include "fast_answer.hpp"
#include "outgoing_queue.hpp"
#include "surefoot/core/rng.hpp"
#include "virtual_servo.hpp"

namespace dynamixel {

/// The line is half-duplex and takes ten bits per byte: answers begin when the instruction is over and the servo's
/// return delay has passed, one after the other, and each is handed out when its last byte is due. What is sent while
/// servos still answer is heard by them, and counted: on a real line both would be lost. Calls allocate nothing.
template <class Protocol>
class Answerer {
 public:
  explicit Answerer(std::vector<VirtualServo> servos, AnswererOptions options = {})
      : servos_(std::move(servos)), options_(options), rng_(options.seed), per_servo_(servos_.size()) {}

  std::uint32_t bits_per_s() const { return options_.bits_per_s; }
  bool own_speeds() const { return options_.own_speeds; }
  /// The host has set its port to that speed.
  void set_speed(std::uint32_t bits_per_s) { options_.bits_per_s = bits_per_s; }
  Faults& faults() { return options_.faults; }
  void set_latency_timer(double seconds) { options_.latency_timer_s = seconds; }
  const FaultCounts& counts() const { return counts_; }
  const FaultCounts& counts(std::uint8_t id) const { return per_servo_[place(id)].counts; }
  std::uint64_t instructions() const { return instructions_; }
  std::uint64_t collisions() const { return collisions_; }
  std::uint64_t sent_bytes() const { return sent_bytes_; }

  VirtualServo& servo(std::uint8_t id) { return servos_[place(id)]; }
  const std::vector<VirtualServo>& servos() const { return servos_; }

  /// A silent servo hears and moves, but does not answer.
  void set_silent(std::uint8_t id, bool silent) { per_servo_[place(id)].silent = silent; }
  void set_voltage(double volts) {
    for (VirtualServo& each : servos_) each.voltage_v = volts;
  }

  /// Did that servo give that answer to an instruction numbered `first` or later? The last eight are remembered.
  bool gave(std::uint8_t id, Bytes data, std::uint64_t first) const {
    for (const GivenAnswer& answer : per_servo_[place(id)].answers) {
      if (answer.instruction >= first && answer.size >= data.size() &&
          std::equal(data.begin(), data.end(), answer.data.begin())) {
        return true;
      }
    }
    return false;
  }

  /// The host sends.
  void receive(Bytes bytes, Time now) {
    if (now < answers_end_ && !bytes.empty()) ++collisions_;
    for (const std::uint8_t byte : bytes) {
      line_free_ = std::max(line_free_, now) + line_time(1, options_.bits_per_s);
      decoder_.push(byte);
      while (const auto packet = decoder_.next()) obey(*packet);
    }
  }

  /// When the next answer is due.
  std::optional<Time> next_due() const { return outgoing_.next_due(); }

  /// The next answer that is due by `now`, if `out` has room for it; its size, or 0.
  std::size_t take(Time now, Buffer out) {
    const std::size_t size = outgoing_.take(now, out);
    sent_bytes_ += size;
    return size;
  }

  /// Moves the motors to `now`, and their watchdogs.
  void advance(Time now) {
    for (VirtualServo& each : servos_) each.advance(now);
  }
  /// As by a switch: they lose their RAM and are silent until they have started.
  void reboot(std::uint8_t id, Time now) { servo(id).reboot(now); }
  void swap_ids(std::uint8_t a, std::uint8_t b) {
    VirtualServo &first = servo(a), &second = servo(b);
    first.set("id", b);
    second.set("id", a);
  }

 private:
  struct PerServo {
    bool silent = false;
    FaultCounts counts;
    std::array<GivenAnswer, 8> answers{};
    std::size_t next_answer = 0;
  };

  std::size_t place(std::uint8_t id) const {
    const auto at = find(id);
    if (!at) throw BusError("virtual bus: there is no servo with id " + std::to_string(id) + "; give one it has");
    return *at;
  }
  std::optional<std::size_t> find(std::uint8_t id) const {
    for (std::size_t i = 0; i < servos_.size(); ++i) {
      if (servos_[i].id() == id) return i;
    }
    return std::nullopt;
  }

  /// Serial ports agree where their speeds differ by less than 3 %.
  bool hears(const VirtualServo& servo) const {
    const double speed = options_.own_speeds ? servo.bits_per_s() : options_.bits_per_s;
    return servo.hears(line_free_) && std::abs(speed / options_.bits_per_s - 1) < 0.03;
  }

  /// An address, a count: one or two bytes, taken from the front. Too few count as none.
  static std::optional<std::size_t> take_number(Bytes& parameters) {
    if (parameters.size() < Protocol::number_size) return std::nullopt;
    std::size_t number = 0;
    for (std::size_t i = Protocol::number_size; i-- > 0;) number = 256 * number + parameters[i];
    parameters = parameters.subspan(Protocol::number_size);
    return number;
  }

  void obey(const Packet& packet) {
    ++instructions_;
    advance(line_free_);
    if (options_.faults.unheard > 0 && rng_.uniform() < options_.faults.unheard) return;
    for (VirtualServo& each : servos_) each.note_instruction(line_free_);
    Bytes rest = packet.parameters;
    switch (static_cast<Instruction>(packet.code)) {
      case Instruction::sync_write:
        return obey_sync_write(rest);
      case Instruction::bulk_write:
        if constexpr (Protocol::version == 2) obey_bulk_write(rest);
        return;
      case Instruction::sync_read:
        if constexpr (Protocol::version == 2) obey_sync_read(rest);
        return;
      case Instruction::fast_sync_read:
        if constexpr (Protocol::version == 2) {
          if (options_.knows_fast_reads) obey_fast_sync_read(rest);
        }
        return;
      case Instruction::bulk_read:
        return obey_bulk_read(rest);
      case Instruction::action:
        for (VirtualServo& each : servos_) {
          if ((packet.id == broadcast_id || packet.id == each.id()) && hears(each)) each.act();
        }
        if (packet.id != broadcast_id) acknowledge(packet.id, Refusal::none);
        return;
      default:
        for (const VirtualServo& each : servos_) {
          const bool one = packet.id == each.id();
          if (one || packet.id == broadcast_id) obey_single(each.id(), packet, one);
        }
    }
  }

  void obey_single(std::uint8_t id, const Packet& packet, bool answers) {
    VirtualServo& servo = servos_[place(id)];
    if (!hears(servo)) return;
    Bytes rest = packet.parameters;
    const auto code = static_cast<Instruction>(packet.code);
    if (code == Instruction::ping) {
      if constexpr (Protocol::version == 2) {
        std::array<std::uint8_t, 7> head;
        static_cast<void>(servo.read(0, head));
        const std::uint8_t firmware = head[servo.model().find("firmware_version")->address];
        const std::array<std::uint8_t, 3> data{head[0], head[1], firmware};
        answer(servo, {id, servo.error_bits(Refusal::none), false, data});  // a broadcast one too, in turn
      } else if (answers) {
        answer(servo, {id, servo.error_bits(Refusal::none), false, {}});
      }
      return;
    }
    if (code == Instruction::reboot) {
      if (answers) acknowledge(id, Refusal::none);
      return servo.reboot(line_free_);
    }
    const auto address = take_number(rest);
    if (!address) return;
    if (code == Instruction::read) {
      const auto count = take_number(rest);
      if (answers && count) answer_read(id, *address, *count);
    } else if (code == Instruction::write || code == Instruction::reg_write) {
      const Refusal refusal = code == Instruction::write ? servo.write(*address, rest) : servo.store(*address, rest);
      if (answers) acknowledge(servo.id(), refusal);
    }
  }

  void obey_sync_write(Bytes rest) {
    const auto address = take_number(rest), count = take_number(rest);
    if (!address || !count || *count == 0) return;
    for (; rest.size() > *count; rest = rest.subspan(1 + *count)) {
      const auto at = find(rest[0]);
      if (at && hears(servos_[*at])) static_cast<void>(servos_[*at].write(*address, rest.subspan(1, *count)));
    }
  }

  void obey_bulk_write(Bytes rest) {
    while (rest.size() > 1) {
      const auto at = find(rest[0]);
      rest = rest.subspan(1);
      const auto address = take_number(rest), count = take_number(rest);
      if (!address || !count || *count > rest.size()) return;
      if (at && hears(servos_[*at])) static_cast<void>(servos_[*at].write(*address, rest.first(*count)));
      rest = rest.subspan(*count);
    }
  }

  void obey_sync_read(Bytes rest) {
    const auto address = take_number(rest), count = take_number(rest);
    if (!address || !count) return;
    bool goes_on = true;
    for (const std::uint8_t id : rest) goes_on = answer_in_chain(id, *address, *count, goes_on);
  }

  /// Each servo adds its block to one packet; where one is silent, it ends.
  void obey_fast_sync_read(Bytes ids) {
    const auto address = take_number(ids), count = take_number(ids);
    if (!address || !count) return;
    fast_.begin(ids.size(), *count);
    bool goes_on = true;
    for (const std::uint8_t id : ids) {
      const auto at = find(id);
      if (!goes_on && at) note_fault(per_servo_[*at], &FaultCounts::withheld);
      goes_on = goes_on && at && add_block(servos_[*at], *address, *count);
    }
  }

  bool add_block(VirtualServo& servo, std::size_t address, std::size_t count) {
    PerServo& its = per_servo_[place(servo.id())];
    std::array<std::uint8_t, 160> data{};
    if (servo.status_return_level() < 1 || count > data.size()) return false;
    if (its.silent || !hears(servo)) return note_fault(its, &FaultCounts::silent), false;
    const Fault fault = draw_fault(options_.faults, rng_);
    if (fault == Fault::lost || fault == Fault::late) return note_fault(its, &FaultCounts::lost), false;
    const Refusal refusal = servo.read(address, Buffer(data).first(count));
    note_given(its, Bytes(data).first(count));
    if (!fast_.begun()) line_free_ += from_seconds(servo.return_delay());
    OutgoingPacket packet = fast_.add(servo.id(), servo.error_bits(refusal), Bytes(data).first(count));
    line_free_ += line_time(packet.size, options_.bits_per_s);
    packet.due = answers_end_ = line_free_;
    if (fault == Fault::corrupted) {
      corrupt(Buffer(packet.bytes).first(packet.size), options_.faults.corrupted_bytes, rng_);
      note_fault(its, &FaultCounts::corrupted);
    }
    hand_over(packet);
    return true;
  }

  void obey_bulk_read(Bytes rest) {
    if constexpr (Protocol::version == 1) {
      if (!rest.empty()) rest = rest.subspan(1);
    }
    constexpr std::size_t item_size = 1 + 2 * Protocol::number_size;
    bool goes_on = true;
    for (; rest.size() >= item_size; rest = rest.subspan(item_size)) {
      Bytes item = rest;
      if constexpr (Protocol::version == 1) {
        goes_on = answer_in_chain(item[1], item[2], item[0], goes_on);
      } else {
        const std::uint8_t id = item[0];
        item = item.subspan(1);
        const auto address = take_number(item), count = take_number(item);
        if (address && count) goes_on = answer_in_chain(id, *address, *count, goes_on);
      }
    }
  }

  /// False where the chain has ended, after which `goes_on` is false.
  bool answer_in_chain(std::uint8_t id, std::size_t address, std::size_t length, bool goes_on) {
    const auto at = find(id);
    if (!goes_on) {
      if (at) note_fault(per_servo_[*at], &FaultCounts::withheld);
      return false;
    }
    if (at && answer_read(id, address, length)) return true;
    if (options_.chain == Chain::stops) return false;
    line_free_ += from_seconds(options_.chain_patience_s);
    return true;
  }

  void acknowledge(std::uint8_t id, Refusal refusal) {
    const auto at = find(id);
    if (!at || servos_[*at].status_return_level() < 2) return;
    answer(servos_[*at], {id, servos_[*at].error_bits(refusal), false, {}});
  }

  bool answer_read(std::uint8_t id, std::size_t address, std::size_t count) {
    VirtualServo& servo = servos_[place(id)];
    if (servo.status_return_level() < 1) return false;
    std::array<std::uint8_t, 160> data;
    Refusal refusal = count <= data.size() ? Refusal::none : Refusal::range;
    if (refusal == Refusal::none) refusal = servo.read(address, Buffer(data).first(count));
    const Bytes read = Bytes(data).first(refusal == Refusal::none ? count : 0);
    return answer(servo, {id, servo.error_bits(refusal), false, read});
  }

  /// Puts a status packet on the line, with what happens to it. False where the servo sends nothing in its turn.
  bool answer(VirtualServo& servo, Status status) {
    PerServo& its = per_servo_[place(servo.id())];
    if (its.silent || !hears(servo)) return note_fault(its, &FaultCounts::silent), false;
    const Fault fault = draw_fault(options_.faults, rng_);
    if (fault == Fault::lost) return note_fault(its, &FaultCounts::lost), false;
    if (fault == Fault::wrong_id && servos_.size() > 1) {
      const auto other =
          (place(servo.id()) + 1 + rng_.below(static_cast<std::uint32_t>(servos_.size()) - 1)) % servos_.size();
      status.id = servos_[other].id();
      note_fault(its, &FaultCounts::wrong_id);
    } else {
      note_given(its, status.data);
    }
    OutgoingPacket packet;
    packet.size = Protocol::status(packet.bytes, status).size();
    if (fault == Fault::late) {
      packet.due = line_free_ + from_seconds(options_.faults.late_s);
      hand_over(packet);
      return note_fault(its, &FaultCounts::late), false;
    }
    line_free_ += from_seconds(servo.return_delay()) + line_time(packet.size, options_.bits_per_s);
    packet.due = line_free_;
    if (fault == Fault::corrupted) {
      corrupt(Buffer(packet.bytes).first(packet.size), options_.faults.corrupted_bytes, rng_);
      note_fault(its, &FaultCounts::corrupted);
    } else if (fault == Fault::duplicated) {
      note_fault(its, &FaultCounts::duplicated);
      hand_over(packet);
      line_free_ += line_time(packet.size, options_.bits_per_s);
      packet.due = line_free_;
    }
    hand_over(packet);
    answers_end_ = line_free_;
    return true;
  }

  void note_given(PerServo& its, Bytes data) {
    GivenAnswer& given = its.answers[its.next_answer++ % its.answers.size()];
    given.instruction = instructions_;
    given.size = data.size();
    std::copy(data.begin(), data.end(), given.data.begin());
  }

  /// The adapter hands bytes over each time its latency timer has run out.
  void hand_over(OutgoingPacket packet) {
    const Time period = from_seconds(options_.latency_timer_s);
    if (period > Time::zero()) packet.due = (packet.due / period + 1) * period;
    outgoing_.add(packet);
  }

  void note_fault(PerServo& its, std::uint64_t FaultCounts::*which) {
    ++(counts_.*which);
    ++(its.counts.*which);
  }

  std::vector<VirtualServo> servos_;
  AnswererOptions options_;
  surefoot::Rng rng_;
  std::vector<PerServo> per_servo_;  // in the order of servos_
  FaultCounts counts_;
  typename Protocol::template Decoder<1024> decoder_;
  OutgoingQueue outgoing_;
  Time line_free_{};    // when the last byte put on the line is over
  Time answers_end_{};  // when the last byte of the servos is
  std::uint64_t instructions_ = 0;
  std::uint64_t collisions_ = 0;
  std::uint64_t sent_bytes_ = 0;
  FastAnswer fast_;
};

}  // namespace dynamixel

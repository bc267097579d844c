// The reading of all joints of a group: as much of each, and as many in a cycle, as there is time for.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../bus/bus.hpp"
#include "feedback.hpp"
#include "joint.hpp"
#include "reading_time.hpp"

namespace dynamixel {

/// `ServoBus` is a Bus. Nothing is allocated in a read. `bus`, `model` and `joints` must outlive this.
template <class ServoBus>
class JointReader {
 public:
  JointReader(ServoBus& bus, const ServoModel& model, const std::vector<Joint>& joints, FeedbackKind kind)
      : bus_(&bus), model_(&model), joints_(&joints), kind_(kind), feedback_(model, kind), outcomes_(joints.size()) {
    read_all();
  }

  const Feedback& feedback() const { return feedback_; }
  FeedbackKind kind() const { return kind_; }

  /// However long it takes.
  void read_all() {
    part_ = joints_->size();
    turn_ = 0;
    received_.assign(part_ * feedback_.count(), 0);
    heard_ = received_;
  }

  /// Motion without health where `time` is too short for both, and as many servos in a cycle as it allows: those that
  /// are asked answer to the end, whoever speaks meanwhile.
  void fit_into(Time time) {
    const auto fits = [&](std::size_t servos) {
      return reading_time<typename ServoBus::Wire>(servos, feedback_.count(), bus_->options().return_delay_s,
                                                   bus_->port().bits_per_s()) <= time;
    };
    if (fits(part_)) return;
    kind_ = FeedbackKind::motion;
    feedback_ = Feedback(*model_, kind_);
    read_all();
    while (part_ > 1 && !fits(part_)) --part_;
  }

  /// Those whose turn it is. Returns how many answered.
  std::size_t read(Time deadline) {
    const std::size_t count = feedback_.count();
    std::array<std::uint8_t, max_servos> ids{};
    std::array<Outcome, max_servos> outcomes{};
    const auto joint_of = [&](std::size_t k) { return (turn_ + k) % joints_->size(); };
    for (std::size_t k = 0; k < part_; ++k) ids[k] = (*joints_)[joint_of(k)].id;
    const std::size_t answered =
        bus_->sync_read(feedback_.address(), feedback_.count(), Bytes(ids).first(part_),
                        Buffer(heard_).first(part_ * count), std::span(outcomes).first(part_), deadline);
    std::fill(outcomes_.begin(), outcomes_.end(), Outcome::skipped);
    for (std::size_t k = 0; k < part_; ++k) {
      outcomes_[joint_of(k)] = outcomes[k];
      const Bytes bytes = Bytes(heard_).subspan(k * count, count);
      if (outcomes[k] != Outcome::answered) continue;
      std::copy(bytes.begin(), bytes.end(), received_.begin() + static_cast<std::ptrdiff_t>(joint_of(k) * count));
    }
    turn_ = joint_of(part_);
    return answered;
  }

  /// In the last read(); skipped where its turn had not come.
  Outcome outcome(std::size_t joint) const { return outcomes_[joint]; }
  /// What the joint's servo answered last, from feedback().address() on.
  Bytes received(std::size_t joint) const {
    return Bytes(received_).subspan(joint * feedback_.count(), feedback_.count());
  }

 private:
  ServoBus* bus_;
  const ServoModel* model_;
  const std::vector<Joint>* joints_;
  FeedbackKind kind_;
  Feedback feedback_;
  std::vector<Outcome> outcomes_;
  std::vector<std::uint8_t> received_, heard_;  // of all; of those asked, in their order
  std::size_t part_ = 0, turn_ = 0;             // how many are asked in a cycle, and who is the first
};

}  // namespace dynamixel

// Joints on several serial lines as one group: all lines are driven at the same time, and a line that sits down or lets
// go takes the others along.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "line_workers.hpp"
#include "servo_group.hpp"

namespace dynamixel {

/// `Group` is a ServoGroup; each has a bus of its own. With one line it is that group and no more. Nothing is allocated
/// after construction. For one thread.
template <class Group>
class JointLines {
 public:
  /// `line_of` has the line of each joint; a line's group has its joints in the same order. The groups must outlive
  /// this.
  JointLines(std::vector<Group*> lines, std::vector<std::size_t> line_of)
      : lines_(std::move(lines)),
        line_of_(std::move(line_of)),
        joints_of_(lines_.size()),
        errors_(lines_.size()),
        workers_(lines_.size()) {
    for (std::size_t i = 0; i < line_of_.size(); ++i) {
      place_.push_back(joints_of_.at(line_of_[i]).size());
      joints_of_[line_of_[i]].push_back(i);
    }
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      goals_.emplace_back(joints_of_[i].size());
      if (lines_[i]->joints().size() != joints_of_[i].size())
        throw BusError("joints: a line has another number of them");
    }
    states_.resize(line_of_.size());
    events_.reserve(6 * line_of_.size() + 4);
    take_states();
  }

  /// Checks all lines, then switches the torque of all on. Where one cannot, BusError, and the torque of all is off.
  void start() {
    at_once([](Group& line) { line.prepare(); });
    at_once([](Group& line) { line.switch_on(); });
    take_states();
  }

  /// Angles of the joints in their order [rad]. False if there are not as many, or one is not finite: then none counts.
  bool set_goals(std::span<const double> goals_rad) {
    const bool finite = std::ranges::all_of(goals_rad, [](double goal) { return std::isfinite(goal); });
    if (goals_rad.size() != states_.size() || !finite) return false;
    for (std::size_t i = 0; i < goals_rad.size(); ++i) goals_[line_of_[i]][place_[i]] = goals_rad[i];
    for (std::size_t i = 0; i < lines_.size(); ++i) lines_[i]->set_goals(goals_[i]);
    return true;
  }

  /// One cycle of all lines. Where it throws, the torque of all is off. Returns how many joints answered.
  std::size_t update() {
    at_once([](Group& line) { line.update(); });
    take_states();
    take_events();
    const auto sits = [](const Group* line) { return line->sitting(); };
    const auto limp = [](const Group* line) { return !line->torque_on(); };
    if (std::ranges::any_of(lines_, limp)) {
      let_go();
    } else if (std::ranges::any_of(lines_, sits)) {
      sit_down();
    }
    return static_cast<std::size_t>(std::ranges::count_if(states_, &JointState::fresh));
  }

  void sit_down() {
    for (Group* line : lines_) line->sit_down();
  }
  void let_go() {
    for (Group* line : lines_) line->let_go();
  }
  void keep_torque() noexcept {
    for (Group* line : lines_) line->keep_torque();
  }

  /// Of the last update().
  std::span<const ServoEvent> events() const { return events_; }
  std::span<const JointState> states() const { return states_; }
  double sent_goal(std::size_t joint) const { return lines_[line_of_[joint]]->sent_goal(place_[joint]); }
  bool torque_on() const {
    return std::ranges::any_of(lines_, [](const Group* line) { return line->torque_on(); });
  }
  bool sitting() const {
    return std::ranges::any_of(lines_, [](const Group* line) { return line->sitting(); });
  }
  /// Why it sat down or let go by itself: of the first line that did.
  std::optional<ServoFault> fault() const {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (const auto& fault = lines_[i]->fault()) return ServoFault{joints_of_[i][fault->joint], fault->finding};
    }
    return std::nullopt;
  }
  /// Servos that did not say after the last stop that their torque is off.
  std::size_t unconfirmed() const {
    std::size_t sum = 0;
    for (const Group* line : lines_) sum += line->unconfirmed();
    return sum;
  }

  Time now() const { return lines_.front()->now(); }
  /// Until then by the clock of each line.
  void wait_until(Time time) {
    for (Group* line : lines_) line->wait_until(time);
  }

 private:
  /// action(line) for all at the same time. The first error is thrown when all are done, and the torque of all is off.
  template <class Action>
  void at_once(Action action) {
    workers_.run([&](std::size_t i) {
      errors_[i] = nullptr;
      try {
        action(*lines_[i]);
      } catch (...) {
        errors_[i] = std::current_exception();
      }
    });
    for (const std::exception_ptr& error : errors_) {
      if (!error) continue;
      for (Group* line : lines_) line->stop();
      std::rethrow_exception(error);
    }
  }

  void take_states() {
    for (std::size_t i = 0; i < states_.size(); ++i) states_[i] = lines_[line_of_[i]]->states()[place_[i]];
  }

  /// What is of all is told once.
  void take_events() {
    events_.clear();
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      for (ServoEvent event : lines_[i]->events()) {
        const bool of_all = is_of_all(event.kind);
        if (of_all && std::ranges::count(events_, event.kind, &ServoEvent::kind) > 0) continue;
        if (!of_all) event.joint = joints_of_[i][event.joint];
        if (events_.size() < events_.capacity()) events_.push_back(event);
      }
    }
  }

  std::vector<Group*> lines_;
  std::vector<std::size_t> line_of_, place_;         // of each joint: its line, its place there
  std::vector<std::vector<std::size_t>> joints_of_;  // of each line
  std::vector<std::vector<double>> goals_;           // of each line [rad]
  std::vector<JointState> states_;
  std::vector<ServoEvent> events_;
  std::vector<std::exception_ptr> errors_;
  LineWorkers workers_;
};

}  // namespace dynamixel

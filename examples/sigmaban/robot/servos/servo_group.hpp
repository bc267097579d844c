// Joints on one bus, made safe: nothing leaves its limits, nothing jumps, and the torque goes off when nobody gives
// goals any more, when the program ends and when anything throws. What becomes of faults of servos is in the table of
// servo_condition.hpp; the README has it in words.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../bus/bus.hpp"
#include "joint.hpp"
#include "joint_goals.hpp"
#include "joint_reader.hpp"
#include "joint_states.hpp"
#include "servo_group_types.hpp"
#include "servo_keeper.hpp"
#include "servo_registers.hpp"
#include "servo_start.hpp"
#include "torque_switch.hpp"

namespace dynamixel {

/// `ServoBus` is a Bus. Nothing is allocated after construction. For one thread.
///
///   ServoGroup group(bus, mx_64_protocol_2, joints);
///   group.start();                               // torque on, where the joints are
///   while (group.torque_on()) { group.set_goals(goals); group.update(); sleep_until_next_cycle(); }
template <class ServoBus>
class ServoGroup {
 public:
  /// Throws BusError where joints make no sense. `bus` and `model` must outlive this.
  ServoGroup(ServoBus& bus, const ServoModel& model, std::vector<Joint> joints, ServoGroupOptions options = {})
      : bus_(&bus),
        joints_(std::move(joints)),
        options_(std::move(options)),
        reader_(bus, model, joints_, options_.feedback),
        supply_(model, FeedbackKind::health),
        registers_(bus, model, ids_of(joints_), options_.bus_watchdog_s),
        torque_(bus, registers_, options_.guard),
        keeper_(registers_, joints_.size(), options_.care),
        states_(joints_),
        goals_(joints_, model),
        presences_(joints_.size(), Presence(bus.port().now())),
        events_(joints_.size()) {
    check_joints(joints_, max_servos, model);
    const std::size_t sitting = options_.sitting_rad.size();
    if (sitting != 0 && sitting != joints_.size()) throw BusError("joints: the way they sit is of another number");
  }

  ~ServoGroup() {
    if (torque_on()) stop();
  }
  ServoGroup(const ServoGroup&) = delete;
  ServoGroup& operator=(const ServoGroup&) = delete;

  /// Torque on at the measured angles, which are the first goals. Throws BusError, torque off, where a servo does not
  /// answer or something is wrong with it; see why_not_to_start().
  void start() {
    prepare();
    switch_on();
  }

  /// The first half of start(): finds all servos and checks them, the torque stays off.
  void prepare() {
    guarded([&] {
      sitting_since_.reset();
      limp_ = false;
      keeper_.begin();
      std::fill(presences_.begin(), presences_.end(), Presence(bus_->port().now()));
      states_.forget();
      reader_.read_all();
      registers_.write_all("bus_watchdog", 0);  // of a program that was killed: it would refuse goals
      find_servos(
          *bus_, registers_, joints_, options_.find_s, [&] { listen(Time::max(), options_.find_s); },
          [&](std::size_t i) { return states_.heard(i); });
      reader_.fit_into(from_seconds(options_.listen_s - bus_->options().latency_s));
      const StartCriteria criteria{options_.alarms, options_.most_beyond_limits_rad};
      for (std::size_t i = 0; i < joints_.size(); ++i) {
        check_before_start(*bus_, registers_, supply_, joints_[i], i, criteria, states_[i]);
      }
    });
  }

  /// The second half, at once after the first.
  void switch_on() {
    guarded([&] {
      for (std::size_t i = 0; i < joints_.size(); ++i) {
        goals_.hold(i, states_[i].position_rad);
        goals_.begin_softly(i, states_[i].position_rad, bus_->port().now(), options_.soft_start_s);
      }
      torque_.on();
      switch_torque_on(
          *bus_, registers_, joints_, [&] { send_goals(); }, goals_.last_ticks());
      last_goals_ = bus_->port().now();
      events_.clear();
    });
  }

  /// Torque off, told three times, and again to those who say that theirs is on. Throws nothing.
  void stop() noexcept {
    sitting_since_.reset();
    torque_.off();
  }

  /// Leaves the torque as it is, for good: nothing switches it off any more, neither here nor in the servos.
  void keep_torque() noexcept { torque_.leave(); }

  /// Angles of the joints in their order [rad]. False if there are not as many, or one is not finite: then none counts.
  bool set_goals(std::span<const double> goals_rad) {
    const bool finite =
        std::all_of(goals_rad.begin(), goals_rad.end(), [](double goal) { return std::isfinite(goal); });
    if (goals_rad.size() != joints_.size() || !finite) {
      ++refused_goals_;
      return false;
    }
    for (std::size_t i = 0; i < joints_.size() && !sitting_since_; ++i) {
      const bool within = goals_.set(i, goals_rad[i], options_.beyond_limits == BeyondLimits::refuse);
      states_[i].goals_beyond_limits += within ? 0U : 1U;
    }
    if (!goals_are_late()) last_goals_ = bus_->port().now();  // else it is for update() to switch the torque off
    return true;
  }

  /// From the present goals to sitting_rad, then torque off; goals do not count from now on. At once where there is no
  /// sitting_rad.
  void sit_down() {
    if (!torque_on() || sitting_since_) return;
    if (options_.sitting_rad.empty()) return let_go();
    sitting_since_ = bus_->port().now();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      goals_.begin_softly(i, *sitting_since_, options_.sit_s);
      goals_.set(i, options_.sitting_rad[i], false);
    }
    note({ServoEventKind::sitting, 0});
  }

  /// Torque off now.
  void let_go() {
    if (!torque_on()) return;
    stop();
    note({ServoEventKind::let_go, 0});
  }

  /// One cycle: sends the goals if the torque is on, then reads all joints and the health of one. Returns how many
  /// answered. Where it throws, the torque is off. Ends at `deadline` or after listen_s and poll_s, whichever is first.
  std::size_t update(Time deadline = Time::max()) {
    std::size_t answered = 0;
    guarded([&] {
      events_.begin_cycle();
      const Time now = bus_->port().now();
      if (torque_on()) look_at_watchdogs();
      if (sitting_since_ && now - *sitting_since_ > from_seconds(options_.sit_s + settle_s)) let_go();
      if (torque_on()) {
        send_goals();
        keeper_.send_torque();
      } else if (limp_) {
        registers_.write_all("torque_enable", 0);  // for those who did not hear it
      }
      answered = listen(deadline, options_.listen_s);
      if (torque_on()) take_care(std::min(deadline, now + from_seconds(options_.listen_s + options_.care.poll_s)));
      events_.end_cycle();
    });
    return answered;
  }

  /// Of the last update(), with what was done between it and the one before it.
  std::span<const ServoEvent> events() const { return events_.all(); }
  std::span<const JointState> states() const { return states_.all(); }
  /// What the joint was sent last [rad].
  double sent_goal(std::size_t joint) const { return goals_.sent(joint); }
  /// The bytes that the joint's servo answered last, from feedback().address() on.
  Bytes received(std::size_t joint) const { return reader_.received(joint); }
  const Feedback& feedback() const { return reader_.feedback(); }
  std::span<const Joint> joints() const { return joints_; }
  bool torque_on() const { return torque_.is_on(); }
  bool sitting() const { return sitting_since_.has_value(); }
  /// Why it sat down or let go by itself; none where it did not.
  const std::optional<ServoFault>& fault() const { return keeper_.care().fault(); }
  Reaction reaction() const { return keeper_.care().reaction(); }
  Condition condition(std::size_t joint) const { return keeper_.care().condition(joint); }
  /// Could the last stop() be sent?
  bool stopped() const { return torque_.sent(); }
  /// Servos that did not say after the last stop() that their torque is off.
  std::size_t unconfirmed() const { return torque_.unconfirmed(); }
  std::uint64_t refused_goals() const { return refused_goals_; }  // calls of set_goals() that returned false

  Time now() const { return bus_->port().now(); }
  /// Until then by the clock of the bus.
  void wait_until(Time time) {
    if constexpr (requires { bus_->port().wait_until(time); }) {
      bus_->port().wait_until(time);
    } else {
      std::this_thread::sleep_until(std::chrono::steady_clock::time_point(time));
    }
  }

 private:
  static constexpr double settle_s = 0.1;  // that servos are behind their goals, about [s]

  static std::vector<std::uint8_t> ids_of(const std::vector<Joint>& joints) {
    std::vector<std::uint8_t> ids;
    for (const Joint& joint : joints) ids.push_back(joint.id);
    return ids;
  }

  template <class Action>
  void guarded(Action action) {
    try {
      action();
    } catch (...) {
      stop();
      throw;
    }
  }

  void note(const ServoEvent& event) {
    if (event.kind == ServoEventKind::let_go || event.kind == ServoEventKind::watchdog) limp_ = true;
    events_.note(event);
  }

  bool goals_are_late() const {
    return torque_on() && bus_->port().now() - last_goals_ > from_seconds(options_.watchdog_s);
  }
  void look_at_watchdogs() {
    if (!torque_.guard_fired() && !goals_are_late()) return;
    stop();
    note({ServoEventKind::watchdog, 0});
  }

  void send_goals() {
    registers_.write_each("goal_position", goals_.ticks(bus_->port().now()));
    torque_.beat();
  }

  std::size_t listen(Time latest, double at_most_s) {
    const std::size_t answered = reader_.read(std::min(latest, bus_->port().now() + from_seconds(at_most_s)));
    const Time now = bus_->port().now();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const bool came = reader_.outcome(i) == Outcome::answered;
      states_[i].fresh = came && take_answer(i, now);
      const PresenceChange change =
          presences_[i].update(reader_.outcome(i) != Outcome::skipped, came, now, options_.presence);
      states_[i].silent = presences_[i].silent();
      if (change == PresenceChange::silent) {
        note({ServoEventKind::silent, i});
        find(i, Finding::fell_silent);
      } else if (change == PresenceChange::back) {
        note({ServoEventKind::back, i});
        find(i, Finding::heard);
        if (!sitting_since_) goals_.begin_softly(i, states_[i].position_rad, now, options_.soft_start_s);
      }
    }
    return answered;
  }

  /// False where it cannot be true.
  bool take_answer(std::size_t i, Time now) {
    const ServoState servo = reader_.feedback().parse(received(i));
    const Plausibility plausibility = states_.take_motion(i, servo, now, options_.care, torque_on());
    if (plausibility == Plausibility::implausible) find(i, Finding::implausible);
    if (plausibility != Plausibility::taken) return false;
    if (reader_.kind() != FeedbackKind::motion) take_supply(i, servo);
    return true;
  }

  void take_supply(std::size_t i, const ServoState& servo) {
    states_.take_supply(i, servo, options_.alarms, bus_->statistics(joints_[i].id), [&](ServoEventKind kind) {
      note({kind, i});
    });
  }

  /// Asks one servo how it is, and does what its answer and the others' silence ask for.
  void take_care(Time deadline) {
    ServoCare& care = keeper_.care();
    const auto alert = [&](std::size_t i) {
      return care.condition(i) != Condition::failed && bus_->statistics(joints_[i].id).last_error_bits != 0;
    };
    const Time now = bus_->port().now();
    for (std::size_t i = 0; i < joints_.size() && torque_on(); ++i) {
      const bool long_silent = now - presences_[i].last_heard() > from_seconds(options_.care.silent_longest_s);
      if (long_silent && care.condition(i) == Condition::silent) find(i, Finding::silent_for_long);
    }
    if (const auto i = care.next_to_ask(alert)) {
      if (reader_.kind() == FeedbackKind::motion && ++supply_turn_ % 3 == 0) {
        ask_for_supply(*i, deadline);
      } else if (const auto finding = keeper_.ask(*i, deadline)) {
        find(*i, *finding);
      }
    }
    care.look(now);
    if (care.reaction() == Reaction::sit_down) sit_down();
    if (care.reaction() == Reaction::let_go) let_go();
  }

  void ask_for_supply(std::size_t i, Time deadline) {
    std::array<std::uint8_t, 16> bytes{};
    const Buffer read = Buffer(bytes).first(supply_.count());
    if (bus_->read(joints_[i].id, supply_.address(), read, deadline)) take_supply(i, supply_.parse(read));
  }

  void find(std::size_t i, Finding finding) {
    if (!torque_on() || keeper_.take(i, finding, events_) != Reaction::restore || sitting_since_) return;
    goals_.begin_softly(i, states_[i].position_rad, bus_->port().now(), options_.care.restore_s);
  }

  ServoBus* bus_;
  std::vector<Joint> joints_;
  ServoGroupOptions options_;
  JointReader<ServoBus> reader_;
  Feedback supply_;
  ServoRegisters<ServoBus> registers_;
  TorqueSwitch<ServoBus> torque_;
  ServoKeeper<ServoBus> keeper_;
  JointStates states_;
  JointGoals goals_;
  std::vector<Presence> presences_;
  ServoEvents events_;
  bool limp_ = false;  // let go while updates go on
  std::optional<Time> sitting_since_;
  Time last_goals_{};
  std::size_t supply_turn_ = 0;
  std::uint64_t refused_goals_ = 0;
};

}  // namespace dynamixel

// Joints on one bus, made safe: nothing leaves its limits, nothing jumps, and the torque goes off when nobody gives
// goals any more, when the program ends and when anything throws.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../bus/bus.hpp"
#include "alarms.hpp"
#include "feedback.hpp"
#include "joint.hpp"
#include "presence.hpp"
#include "soft_start.hpp"

namespace dynamixel {

enum class BeyondLimits : std::uint8_t { clamp, refuse };

struct ServoGroupOptions {
  double soft_start_s = 2.0;                         // from the measured to the wanted angles [s]
  double watchdog_s = 0.25;                          // without goals, after which the torque goes off [s]
  double listen_s = 0.008;                           // that update() may take at most [s]
  BeyondLimits beyond_limits = BeyondLimits::clamp;  // refuse: the joint keeps its goal
  FeedbackKind feedback = FeedbackKind::motion_and_health;
  PresenceOptions presence{};
  AlarmOptions alarms{};
};

struct JointState {
  double position_rad = 0;  // of the joint
  double velocity_rad_per_s = 0;
  double voltage_v = 0;
  double temperature_celsius = 0;
  Time measured{};     // when it was received
  bool fresh = false;  // in the last update()
  bool silent = false;
  Alarms alarms{};
  std::uint64_t goals_beyond_limits = 0;  // clamped or refused
};

enum class ServoEventKind : std::uint8_t { silent, back, hot, cool, voltage_wrong, voltage_right, watchdog };

/// What happened, to be said of the joint (or of the watchdog).
constexpr std::string_view in_words(ServoEventKind kind) {
  constexpr std::string_view words[] = {"is silent",
                                        "is back",
                                        "is hot",
                                        "is cool again",
                                        "has a wrong voltage",
                                        "has its voltage back",
                                        "switched the torque off"};
  return words[static_cast<std::size_t>(kind)];
}

struct ServoEvent {
  ServoEventKind kind = ServoEventKind::silent;
  std::size_t joint = 0;  // its place in the group; 0 for the watchdog
};

/// `ServoBus` is a Bus. Nothing is allocated after construction. For one thread.
///
///   ServoGroup group(bus, mx_64_protocol_2, joints);
///   group.start();                               // torque on, where the joints are
///   while (walking) { group.set_goals(goals); group.update(); sleep_until_next_cycle(); }
template <class ServoBus>
class ServoGroup {
 public:
  /// Throws BusError where joints make no sense. `bus` and `model` must outlive this.
  ServoGroup(ServoBus& bus, const ServoModel& model, std::vector<Joint> joints, ServoGroupOptions options = {})
      : bus_(&bus),
        model_(&model),
        joints_(std::move(joints)),
        options_(options),
        feedback_(model, options.feedback),
        states_(joints_.size()),
        goals_(joints_.size()),
        starts_(joints_.size()),
        presences_(joints_.size(), Presence(bus.port().now())),
        outcomes_(joints_.size()),
        received_(joints_.size() * feedback_.count()) {
    check_joints(joints_, max_servos);
    for (const Joint& joint : joints_) ids_.push_back(joint.id);
    events_.reserve(3 * joints_.size() + 1);
    to_send_.reserve(4 * joints_.size());
  }

  ~ServoGroup() {
    if (torque_on_) stop();
  }
  ServoGroup(const ServoGroup&) = delete;
  ServoGroup& operator=(const ServoGroup&) = delete;

  /// Torque on at the measured angles, which are the first goals. Throws BusError, torque off, where a servo does not
  /// answer.
  void start() {
    guarded([&] {
      for (int tries = 0; tries < most_tries && listen() < joints_.size(); ++tries) {
      }
      const Time now = bus_->port().now();
      for (std::size_t i = 0; i < joints_.size(); ++i) {
        if (!states_[i].fresh) fail(i, "does not answer; check its id, its cable and the power");
        goals_[i] = states_[i].position_rad;
        begin_softly(i, now);
      }
      send_goals(now);
      for (std::size_t i = 0; i < joints_.size(); ++i) set_torque(i);
      torque_on_ = true;
      last_goals_ = bus_->port().now();
    });
  }

  /// Torque off, told three times, as nobody answers to that. Throws nothing.
  void stop() noexcept {
    torque_on_ = false;
    const Register* torque = model_->find("torque_enable");
    std::array<std::uint8_t, max_servos> off{};
    try {
      for (int i = 0; i < 3; ++i) bus_->sync_write(torque->address, ids_, Bytes(off).first(ids_.size()));
      stopped_ = true;
    } catch (...) {
      stopped_ = false;  // the port is gone, and with it all that can be done
    }
  }

  /// Leaves the torque as it is, for good: nothing here switches it off any more.
  void keep_torque() noexcept { torque_on_ = false; }

  /// Angles of the joints in their order [rad]. False if there are not as many, or one is not finite: then none counts.
  bool set_goals(std::span<const double> goals_rad) {
    const bool finite =
        std::all_of(goals_rad.begin(), goals_rad.end(), [](double goal) { return std::isfinite(goal); });
    if (goals_rad.size() != joints_.size() || !finite) {
      ++refused_goals_;
      return false;
    }
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const double within = std::clamp(goals_rad[i], joints_[i].min_rad, joints_[i].max_rad);
      if (within != goals_rad[i]) ++states_[i].goals_beyond_limits;
      if (within == goals_rad[i] || options_.beyond_limits == BeyondLimits::clamp) goals_[i] = within;
    }
    last_goals_ = bus_->port().now();
    return true;
  }

  /// One cycle: sends the goals if the torque is on, then reads all joints. Returns how many answered. Where it throws,
  /// the torque is off. Ends at `deadline` or after listen_s, whichever is first.
  std::size_t update(Time deadline = Time::max()) {
    std::size_t answered = 0;
    guarded([&] {
      events_.clear();
      const Time now = bus_->port().now();
      if (torque_on_ && now - last_goals_ > from_seconds(options_.watchdog_s)) {
        stop();
        events_.push_back({ServoEventKind::watchdog, 0});
      }
      if (torque_on_) send_goals(now);
      answered = listen(deadline);
    });
    return answered;
  }

  /// Of the last update().
  std::span<const ServoEvent> events() const { return events_; }
  std::span<const JointState> states() const { return states_; }
  /// The bytes that the joint's servo answered last, from feedback().address() on.
  Bytes received(std::size_t joint) const {
    return Bytes(received_).subspan(joint * feedback_.count(), feedback_.count());
  }
  const Feedback& feedback() const { return feedback_; }
  std::span<const Joint> joints() const { return joints_; }
  bool torque_on() const { return torque_on_; }
  /// Could the last stop() be sent?
  bool stopped() const { return stopped_; }
  std::uint64_t refused_goals() const { return refused_goals_; }  // calls of set_goals() that returned false

 private:
  static constexpr int most_tries = 5;  // of each step of the start

  [[noreturn]] void fail(std::size_t joint, const std::string& what) const {
    throw BusError("joint " + joints_[joint].name + " (servo " + std::to_string(joints_[joint].id) + "): " + what);
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

  void begin_softly(std::size_t joint, Time now) {
    starts_[joint] = {now, states_[joint].position_rad, options_.soft_start_s};
  }

  void set_torque(std::size_t joint) {
    const std::uint8_t on = 1;
    Reply reply;
    for (int tries = 0; tries < most_tries && !reply; ++tries) {
      reply = bus_->write(ids_[joint], model_->find("torque_enable")->address, Bytes(&on, 1));
    }
    if (!reply) fail(joint, "does not switch its torque on (" + std::string(name_of(reply.outcome)) + ")");
  }

  void send_goals(Time now) {
    const Register& goal = *model_->find("goal_position");
    to_send_.clear();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const double softly = std::clamp(starts_[i](goals_[i], now), lowest(i), highest(i));
      const double within =
          std::clamp(servo_angle(joints_[i], softly), radians_from_ticks(0), radians_from_ticks(max_ticks));
      const std::uint16_t ticks = ticks_from_radians(within).value_or(center_ticks);  // there always is one
      for (unsigned byte = 0; byte < goal.size; ++byte) {
        to_send_.push_back(byte < 2 ? static_cast<std::uint8_t>(ticks >> (8 * byte)) : std::uint8_t{0});
      }
    }
    bus_->sync_write(goal.address, ids_, to_send_);
  }

  /// A joint that starts beyond its limits comes back softly, too.
  double lowest(std::size_t i) const { return std::min(joints_[i].min_rad, starts_[i].from_rad); }
  double highest(std::size_t i) const { return std::max(joints_[i].max_rad, starts_[i].from_rad); }

  std::size_t listen(Time latest = Time::max()) {
    const Time deadline = std::min(latest, bus_->port().now() + from_seconds(options_.listen_s));
    const std::size_t answered =
        bus_->sync_read(feedback_.address(), feedback_.count(), ids_, received_, outcomes_, deadline);
    const Time now = bus_->port().now();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      states_[i].fresh = outcomes_[i] == Outcome::answered;
      if (states_[i].fresh) take(i, now);
      const PresenceChange change =
          presences_[i].update(outcomes_[i] != Outcome::skipped, states_[i].fresh, now, options_.presence);
      states_[i].silent = presences_[i].silent();
      if (change == PresenceChange::silent) events_.push_back({ServoEventKind::silent, i});
      if (change != PresenceChange::back) continue;
      events_.push_back({ServoEventKind::back, i});
      begin_softly(i, now);
    }
    return answered;
  }

  void take(std::size_t i, Time now) {
    const ServoState servo = feedback_.parse(received(i));
    JointState& state = states_[i];
    state.position_rad = joint_angle(joints_[i], servo.angle_rad);
    state.velocity_rad_per_s = joints_[i].sign * servo.velocity_rad_per_s;
    state.measured = now;
    if (options_.feedback == FeedbackKind::motion) return;
    state.voltage_v = servo.voltage_v;
    state.temperature_celsius = servo.temperature_celsius;
    note_voltage(bus_->statistics(ids_[i]), servo.voltage_v);
    note_temperature(bus_->statistics(ids_[i]), servo.temperature_celsius);
    const Alarms alarms = update_alarms(state.alarms, servo.temperature_celsius, servo.voltage_v, options_.alarms);
    if (alarms.hot != state.alarms.hot) {
      events_.push_back({alarms.hot ? ServoEventKind::hot : ServoEventKind::cool, i});
    }
    if (alarms.voltage != state.alarms.voltage) {
      events_.push_back({alarms.voltage ? ServoEventKind::voltage_wrong : ServoEventKind::voltage_right, i});
    }
    state.alarms = alarms;
  }

  ServoBus* bus_;
  const ServoModel* model_;
  std::vector<Joint> joints_;
  ServoGroupOptions options_;
  Feedback feedback_;
  std::vector<JointState> states_;
  std::vector<double> goals_;  // within limits [rad]
  std::vector<SoftStart> starts_;
  std::vector<Presence> presences_;
  std::vector<Outcome> outcomes_;
  std::vector<std::uint8_t> received_;
  std::vector<std::uint8_t> ids_;
  std::vector<std::uint8_t> to_send_;
  std::vector<ServoEvent> events_;
  bool torque_on_ = false;
  bool stopped_ = false;
  Time last_goals_{};
  std::uint64_t refused_goals_ = 0;
};

}  // namespace dynamixel

// Events of a group of servos: what happened to whom.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace dynamixel {

enum class ServoEventKind : std::uint8_t {
  silent,
  back,
  hot,
  cool,
  voltage_wrong,
  voltage_right,
  watchdog,
  reset,
  restored,
  failed,
  sitting,
  let_go
};

/// What happened, to be said of the joint; of the watchdog; or of the robot for the last two.
constexpr std::string_view in_words(ServoEventKind kind) {
  constexpr std::string_view words[] = {"is silent",
                                        "is back",
                                        "is hot",
                                        "is cool again",
                                        "has a wrong voltage",
                                        "has its voltage back",
                                        "switched the torque off",
                                        "lost its torque or its settings",
                                        "has its torque and its settings back",
                                        "failed",
                                        "sits down",
                                        "let go: the torque of all is off"};
  return words[static_cast<std::size_t>(kind)];
}

struct ServoEvent {
  ServoEventKind kind = ServoEventKind::silent;
  std::size_t joint = 0;  // its place in the group; 0 where it is of all
};

constexpr bool is_of_all(ServoEventKind kind) {
  return kind == ServoEventKind::watchdog || kind == ServoEventKind::sitting || kind == ServoEventKind::let_go;
}

/// Those of a cycle and of what was done before it. Nothing is allocated after construction.
class ServoEvents {
 public:
  explicit ServoEvents(std::size_t joints) { events_.reserve(6 * joints + 4); }

  void note(const ServoEvent& event) {
    if (events_.size() < events_.capacity()) events_.push_back(event);
  }
  /// Forgets those that were there when the last cycle ended.
  void begin_cycle() {
    events_.erase(events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(std::exchange(told_, 0)));
  }
  void end_cycle() { told_ = events_.size(); }
  void clear() {
    events_.clear();
    told_ = 0;
  }
  std::span<const ServoEvent> all() const { return events_; }

 private:
  std::vector<ServoEvent> events_;
  std::size_t told_ = 0;
};

}  // namespace dynamixel

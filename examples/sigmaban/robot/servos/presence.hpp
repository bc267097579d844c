// Whether a servo is there: silent after so many questions or so much time without an answer, back with the first one.
#pragma once

#include "../bus/transport.hpp"

namespace dynamixel {

struct PresenceOptions {
  int silent_cycles = 3;  // in a row, in which its turn came and it did not answer
  double silent_s = 0.2;  // or since the last answer, whether its turn came or not [s]
};

enum class PresenceChange { none, silent, back };

class Presence {
 public:
  /// Counts as heard at `now`.
  explicit Presence(Time now = {}) : last_heard_(now) {}

  /// `asked`: its turn came in this cycle.
  PresenceChange update(bool asked, bool answered, Time now, const PresenceOptions& options) {
    if (answered) {
      last_heard_ = now;
      missed_ = 0;
      if (!silent_) return PresenceChange::none;
      silent_ = false;
      return PresenceChange::back;
    }
    missed_ += asked ? 1 : 0;
    if (silent_ || (missed_ < options.silent_cycles && now - last_heard_ < from_seconds(options.silent_s))) {
      return PresenceChange::none;
    }
    silent_ = true;
    return PresenceChange::silent;
  }

  bool silent() const { return silent_; }
  Time last_heard() const { return last_heard_; }

 private:
  Time last_heard_;
  int missed_ = 0;
  bool silent_ = false;
};

}  // namespace dynamixel

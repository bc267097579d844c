// The twin under our walk engine: walk commands in, displacements out, one full walk cycle (two steps) at a time.
#pragma once

#include <deque>
#include <optional>

#include "../robot/balance/stabilized_walk.hpp"
#include "../robot/walk_engine/spline_walk.hpp"
#include "pusher.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "twin.hpp"

namespace sigmaban {

struct WalkingTwinOptions {
  TwinParameters twin;
  TwinSwitches switches;
  WalkParameters walk = twin_walk();
  double target_noise = 0;  // standard deviation, on every joint target [rad]
  int cycles_on_spot = 3;   // before anything is commanded
  double standing = 0.5;    // before that [s]
  PushOptions pushes;
  bool stabilized = false;  // the walk feels the body's sensors
  StabilizerOptions stabilizer;
};

class WalkingTwin {
 public:
  /// Stands, then walks on the spot. `noise` draws the noise on the targets, if there is any. Throws TwinError for
  /// parameters that cannot be walked with.
  explicit WalkingTwin(const WalkingTwinOptions& options = {}, surefoot::Rng noise = surefoot::Rng(0));

  /// One walk cycle, from walk phase 0 to where the phase wraps, with commands per step (forward, left, turn)
  /// [m, m, rad]: the displacement of the trunk, seen from where it was at the cycle's start. `each_tick(twin)` is
  /// called after every command period. A robot that has fallen does not go on.
  template <class EachTick>
  surefoot::Pose2 cycle(const surefoot::Vec<3>& commands, EachTick&& each_tick);
  surefoot::Pose2 cycle(const surefoot::Vec<3>& commands) {
    return cycle(commands, [](const Twin&) {});
  }

  const Twin& twin() const { return twin_; }
  Twin& twin() { return twin_; }
  bool fallen() const { return twin_.fallen(); }

 private:
  /// The commands that take effect now. Throws TwinError unless `commands` are finite.
  WalkOrders delayed(const surefoot::Vec<3>& commands);
  void tick(const WalkOrders& commands);

  double target_noise_;
  Twin twin_;
  bool stabilized_;
  StabilizedWalk<SplineWalk, HandedReading> engine_;
  surefoot::Rng noise_;
  Pusher pusher_;
  std::deque<surefoot::Vec<3>> waiting_;  // commands given that are not in effect yet, oldest first
};

template <class EachTick>
surefoot::Pose2 WalkingTwin::cycle(const surefoot::Vec<3>& commands, EachTick&& each_tick) {
  const WalkOrders now = delayed(commands);
  const surefoot::Pose2 start = twin_.pose();
  double phase = 0;
  do {
    if (twin_.fallen()) break;
    phase = engine_.phase();
    tick(now);
    each_tick(twin_);
  } while (engine_.phase() >= phase);
  return start.inverse() * twin_.pose();
}

}  // namespace sigmaban

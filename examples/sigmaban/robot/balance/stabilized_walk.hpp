// A walk engine that feels: the stabilisation between the engine and the joints.
#pragma once

#include <optional>
#include <utility>

#include "../walk_engine/walk_engine.hpp"
#include "body_source.hpp"
#include "stabilizer.hpp"

namespace sigmaban {

/// Without readings it is the engine and no more. `step` is to be called once in every control period.
template <WalkEngine Engine, BodySource Body>
class StabilizedWalk {
 public:
  /// `period`: of the control loop [s].
  StabilizedWalk(Engine engine, Body body, double period, const StabilizerOptions& options = {})
      : engine_(std::move(engine)), body_(std::move(body)), period_(period), stabilizer_(options) {}

  double phase() const { return engine_.phase(); }
  Body& body() { return body_; }
  /// Leans so far that it will not stand up again by itself. Never without readings.
  bool fallen() const { return stabilizer_.attitude().fallen(); }

  std::optional<JointTargets> step(const WalkOrders& orders, double duration) {
    const std::optional<BodyReading> reading = body_.feel();
    const double phase = engine_.phase();
    const bool walking = orders.enabled >= 1 && duration > 0;
    if (reading) {
      stabilizer_.feel(*reading, period_, phase, walking);
    } else {
      stabilizer_.feel_nothing();
    }
    const bool waits = reading && walking && stabilizer_.waits(phase, duration);
    auto targets = engine_.step(orders, waits ? 0 : duration);
    if (targets) stabilizer_.correct(*targets, phase);
    return targets;
  }

 private:
  Engine engine_;
  Body body_;
  double period_;
  Stabilizer stabilizer_;
};

}  // namespace sigmaban

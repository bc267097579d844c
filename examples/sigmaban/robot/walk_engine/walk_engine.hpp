// What a walk engine is: orders and the time since the last call in, joint targets out.
#pragma once

#include <cmath>
#include <concepts>
#include <optional>

#include "joint_targets.hpp"

namespace sigmaban {

/// What the robot is asked to do with every step; both feet take one in a walk cycle.
struct WalkOrders {
  double forward = 0;  // [m/step]
  double left = 0;     // [m/step]
  double turn = 0;     // counterclockwise [rad/step]
  double enabled = 1;  // 0 stands still, 1 walks; between them everything that moves is scaled
};

inline bool all_finite(const WalkOrders& orders) {
  return std::isfinite(orders.forward) && std::isfinite(orders.left) && std::isfinite(orders.turn) &&
         std::isfinite(orders.enabled);
}

/// `step` gives the targets of the phase of now, then advances the phase by the duration [s]. Where the feet cannot get
/// it gives none, and the phase stays. It never throws and never gives a number that is not finite.
///
///   struct Statue {
///     double phase() const { return 0; }
///     std::optional<JointTargets> step(const WalkOrders&, double) { return JointTargets{}; }
///   };
template <class Engine>
concept WalkEngine = requires(Engine& engine, const Engine& unchanged, const WalkOrders& orders, double duration) {
  { engine.step(orders, duration) } -> std::same_as<std::optional<JointTargets>>;
  { unchanged.phase() } -> std::convertible_to<double>;  // in [0,1)
};

/// A phase in [0,1), `cycles` after another one. Not finite if they are not.
inline double advance_phase(double phase, double cycles) {
  const double next = phase + cycles;
  const double wrapped = next - std::floor(next);
  return wrapped >= 1.0 ? 0.0 : wrapped;  // rounding may land on 1
}

}  // namespace sigmaban

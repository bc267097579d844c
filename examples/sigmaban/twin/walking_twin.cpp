#include "walking_twin.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace sigmaban {
namespace {

JointTargets with_noise(const JointTargets& targets, double deviation, surefoot::Rng& rng) {
  JointTargets result = targets;
  for (LegJoints* leg : {&result.left, &result.right}) {
    for (double* angle :
         {&leg->hip_yaw, &leg->hip_pitch, &leg->hip_roll, &leg->knee, &leg->ankle_pitch, &leg->ankle_roll}) {
      *angle += deviation * rng.normal();
    }
  }
  return result;
}

}  // namespace

WalkingTwin::WalkingTwin(const WalkingTwinOptions& options, surefoot::Rng noise)
    : target_noise_(options.target_noise),
      twin_(options.twin, options.switches),
      stabilized_(options.stabilized),
      engine_(SplineWalk(options.walk), HandedReading{}, options.twin.order_period, options.stabilizer),
      noise_(std::move(noise)),
      pusher_(options.pushes, noise_.stream(1)),
      waiting_(static_cast<std::size_t>(options.switches.order_delay), surefoot::Vec<3>::Zero()) {
  SplineWalk standing(options.walk);
  const auto stand = standing.step({.enabled = 0}, 0);
  if (!stand) throw TwinError("WalkingTwin: the feet cannot get where these walk parameters put them");
  twin_.reset(*stand);
  const auto ticks = std::lround(options.standing / options.twin.order_period);
  for (long i = 0; i < ticks; ++i) twin_.drive(*stand);
  for (int i = 0; i < options.cycles_on_spot; ++i) cycle(surefoot::Vec<3>::Zero());
}

WalkOrders WalkingTwin::delayed(const surefoot::Vec<3>& commands) {
  if (!commands.allFinite()) throw TwinError("WalkingTwin: a walk command is not finite");
  waiting_.push_back(commands);
  const surefoot::Vec<3> now = waiting_.front();
  waiting_.pop_front();
  return {.forward = now[0], .left = now[1], .turn = now[2]};
}

void WalkingTwin::tick(const WalkOrders& commands) {
  if (stabilized_) engine_.body().newest = twin_.reading();
  const auto targets = engine_.step(commands, twin_.parameters().order_period);
  if (!targets) throw TwinError("WalkingTwin: these commands put a foot out of reach, make them smaller");
  twin_.push(pusher_.force(twin_.time()));
  twin_.drive(target_noise_ > 0 ? with_noise(*targets, target_noise_, noise_) : *targets);
}

}  // namespace sigmaban

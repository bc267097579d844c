// Dry friction that grows smoothly from rest on, as of lubricated bearings, and as most simulators write it:
// level(v) * tanh(v / onset), after L. Marton, B. Lantos: "Modeling, identification, and compensation of stick-slip
// friction", IEEE Trans. Industrial Electronics 54(1), 2007, and many before. It creeps where plain dry friction
// sticks. A form of each dry friction; with an `onset` far below the motion it is the plain one.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// The further parameter of both forms; of a friction with several of its own it has one start, for few combinations.
[[gnu::cold]] inline EffectParameter onset_parameter(const Effect& friction, double low, double high,
                                                     std::vector<double> starts, double only_start) {
  if (friction.parameters.size() > 1) starts = {only_start};
  return {.name = "onset", .measure = {.value = 1}, .low = low, .high = high, .starts = std::move(starts)};
}

/// The same friction, with 76 % of its level at the speed `onset`.
[[gnu::cold]] inline Effect smoothed(Effect friction) {
  friction.sentence += ", which grows from rest on up to speeds of about {onset}";
  friction.parameters.push_back(onset_parameter(friction, 0.001, 0.2, {0.01, 0.05}, 0.02));
  friction.form += friction.form.empty() ? "smooth" : ", smooth";
  for (std::string& form : friction.extends) form += ", smooth";
  friction.force = [level = std::exchange(friction.dry, {})](const EffectContext& m, Values p, Values /*hidden*/) {
    return -level(m, p) * std::tanh(m.value / p.back());
  };
  return friction;
}

/// The same where `onset` is far below the speeds of the motion, so that steps may be longer than that takes: plain dry
/// friction in motion, and where that would hold, the speed at which the friction above balances the force.
[[gnu::cold]] inline Effect creeping(Effect friction) {
  friction.sentence += ", which gives way at speeds of about {onset} where it holds";
  friction.parameters.push_back(onset_parameter(friction, 1e-5, 0.05, {0.001, 0.01}, 0.003));
  friction.extends = {friction.form};
  if (!friction.form.empty()) friction.extends.emplace_back("creeping");
  friction.form += friction.form.empty() ? "creeping" : ", creeping";
  friction.creep = +[](double share, Values p) { return p.back() * std::atanh(share); };
  return friction;
}

}  // namespace surefoot::effects

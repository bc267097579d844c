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

/// The same friction, with 76 % of its level at the speed `onset`.
[[gnu::cold]] inline Effect smoothed(Effect friction) {
  friction.sentence += ", which grows from rest on up to speeds of about {onset}";
  std::vector<double> starts{0.01, 0.05};
  if (friction.parameters.size() > 1) starts = {0.02};  // few combinations with those of the others
  friction.parameters.push_back(
      {.name = "onset", .measure = {.value = 1}, .low = 0.001, .high = 0.2, .starts = std::move(starts)});
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
  std::vector<double> starts{0.001, 0.01};
  if (friction.parameters.size() > 1) starts = {0.003};  // few combinations with those of the others
  friction.parameters.push_back(
      {.name = "onset", .measure = {.value = 1}, .low = 1e-5, .high = 0.05, .starts = std::move(starts)});
  friction.extends = {friction.form};
  if (!friction.form.empty()) friction.extends.emplace_back("creeping");
  friction.form += friction.form.empty() ? "creeping" : ", creeping";
  friction.creep = +[](double share, Values p) { return p.back() * std::atanh(share); };
  return friction;
}

}  // namespace surefoot::effects

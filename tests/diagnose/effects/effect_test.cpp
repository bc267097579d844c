// Effects as values: what an effect must have, and what it is told if it has not.
#include "surefoot/diagnose/effects/effect.hpp"

#include <doctest/doctest.h>

#include <memory>
#include <string>

#include "surefoot/core/error.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"

namespace surefoot {
namespace {

const Effect friction{
    .name = "friction",
    .place = Place::velocity,
    .parameters = {{.name = "level", .measure = {.effort = 1}, .low = 0, .high = 3, .starts = {0.1}, .strength = true}},
    .dry = [](const EffectContext&, Values p) { return p[0]; }};

std::string refusal(const Effect& effect) {
  try {
    check(effect);
  } catch (const DiagnoseError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("all effects of the library pass their own check") {
  for (const Effect& effect : all_effects()) CHECK(refusal(effect) == "");
  CHECK(refusal(friction) == "");
}

TEST_CASE("an effect needs a name") {
  Effect effect = friction;
  effect.name = "";
  CHECK(refusal(effect) == "an effect has no name");
}

TEST_CASE("an effect must do something at its place, and nothing that is never called there") {
  Effect effect = friction;
  effect.dry = {};
  CHECK(refusal(effect) ==
        "effect 'friction': does nothing: at Place::velocity set one of force, position_rate, dry, seen_position, "
        "limit");
  effect = friction;
  effect.place = Place::state;
  CHECK(refusal(effect) ==
        "effect 'friction': the function 'dry' is never called at Place::state; leave it out, or choose another place");
}

TEST_CASE("parameters need a name of their own, bounds in their order and starting values between them") {
  Effect effect = friction;
  effect.parameters[0].name = "";
  CHECK(refusal(effect) == "effect 'friction': a parameter has no name");
  effect = friction;
  effect.parameters.push_back(effect.parameters[0]);
  CHECK(refusal(effect) == "effect 'friction': parameter 'level' stands there twice");
  effect = friction;
  effect.parameters[0].low = 5;
  CHECK(refusal(effect) == "effect 'friction': parameter 'level': low must be below high, and both finite");
  effect = friction;
  effect.parameters[0].starts = {4};
  CHECK(refusal(effect) == "effect 'friction': parameter 'level': a starting value lies outside its bounds");
  effect.parameters[0].of_peak = true;  // a share of the largest value instead
  CHECK(refusal(effect) == "");
  effect.parameters[0].starts = {};
  CHECK(refusal(effect) == "effect 'friction': parameter 'level' has no starting value (starts)");
}

TEST_CASE("hidden states and the functions that change them belong together") {
  Effect effect = friction;
  effect.hidden_states = 1;
  CHECK(refusal(effect) == "effect 'friction': nothing changes its hidden states: set hidden_rate or advance");
  effect.advance = [](const EffectContext&, Values, HiddenStates) {};
  CHECK(refusal(effect) == "");
  effect.hidden_states = 0;
  CHECK(refusal(effect) == "effect 'friction': the function 'advance' needs hidden states, but hidden_states is 0");
  effect.hidden_states = 25;
  CHECK(refusal(effect) == "effect 'friction': hidden_states must be 0 to 24");
}

TEST_CASE("an attached effect is called by its name and place, and is the same with other values") {
  const AttachedEffect one{std::make_shared<const Effect>(friction), 1, -1, "omega", 0};
  AttachedEffect other{std::make_shared<const Effect>(friction), 1, -1, "omega", 7};
  CHECK(one.label() == "friction at omega");
  CHECK(same_effect(one, other));
  other.at = 0;
  CHECK_FALSE(same_effect(one, other));
}

}  // namespace
}  // namespace surefoot

// The catalogue as a whole: names, texts, bounds, and that every effect can be turned off.
#include "surefoot/diagnose/effects/catalogue.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"

namespace surefoot {
namespace {

// What everyone who writes models or reads results relies on.
const std::vector<std::string> stable_names = {"viscous_friction",  "coulomb_friction",
                                               "stribeck_friction", "load_dependent_friction",
                                               "quadratic_drag",    "constant_force",
                                               "cubic_stiffness",   "hysteresis",
                                               "backlash",          "joint_elasticity",
                                               "cogging",           "gravity_offset",
                                               "end_stop",          "leak",
                                               "overflow",          "constant_rate",
                                               "input_gain",        "input_asymmetry",
                                               "dead_zone",         "saturation",
                                               "rate_limit",        "input_delay",
                                               "first_order_lag",   "supply_sag",
                                               "sensor_bias",       "sensor_scale",
                                               "sensor_delay",      "sensor_drift",
                                               "quantization",      "slip_saturation",
                                               "body_drift",        "ground_slope",
                                               "cross_coupling",    "parameter_drift"};

std::set<std::string> names() {
  std::set<std::string> result;
  for (const Effect& effect : all_effects()) result.insert(effect.name);
  return result;
}

// The words between braces.
std::vector<std::string> marks_in(const std::string& sentence) {
  std::vector<std::string> marks;
  for (std::size_t at = sentence.find('{'); at != std::string::npos; at = sentence.find('{', at + 1)) {
    const std::size_t end = sentence.find('}', at);
    REQUIRE(end != std::string::npos);
    marks.push_back(sentence.substr(at + 1, end - at - 1));
  }
  return marks;
}

TEST_CASE("the catalogue holds every stable name and no other") {
  CHECK(names() == std::set<std::string>(stable_names.begin(), stable_names.end()));
}

TEST_CASE("no two effects share name and form") {
  std::set<std::pair<std::string, std::string>> seen;
  for (const Effect& effect : all_effects()) CHECK(seen.insert({effect.name, effect.form}).second);
}

TEST_CASE("sentences speak of every parameter, and of nothing else but the place") {
  for (const Effect& effect : all_effects()) {
    CAPTURE(effect.name);
    std::set<std::string> known;
    for (const EffectParameter& parameter : effect.parameters) known.insert(parameter.name);
    const std::vector<std::string> marks = marks_in(effect.sentence);
    for (const std::string& name : known) {
      if (name != "damping" && name != "frequency") CHECK(std::count(marks.begin(), marks.end(), name) == 1);
    }
    for (const std::string& mark : marks) CHECK((mark == "at" || known.contains(mark)));
  }
}

TEST_CASE("every effect names an experiment and effects of the catalogue that it may be confused with") {
  const std::set<std::string> known = names();
  for (const Effect& effect : all_effects()) {
    CAPTURE(effect.name);
    CHECK(effect.experiment.size() > 20);
    CHECK_FALSE(effect.confusable_with.empty());
    for (const std::string& other : effect.confusable_with) {
      CHECK(known.contains(other));
      CHECK(other != effect.name);
    }
  }
}

TEST_CASE("starting values lie within their bounds, and are few") {
  for (const Effect& effect : all_effects()) {
    CAPTURE(effect.name);
    std::size_t combinations = 1;
    for (const EffectParameter& parameter : effect.parameters) {
      CAPTURE(parameter.name);
      CHECK(parameter.low < parameter.high);
      CHECK_FALSE(parameter.starts.empty());
      combinations *= parameter.starts.size();
      for (const double start : parameter.starts) {
        CHECK(start >= parameter.low);
        CHECK(start <= parameter.high);
        if (parameter.strength && effect.extends.empty()) CHECK(start > 0);
      }
    }
    CHECK(combinations <= (effect.needs_turns ? 32 : 16));  // whole numbers have no others near them
  }
}

TEST_CASE("measures belong to the place of attachment") {
  for (const Effect& effect : all_effects()) {
    CAPTURE(effect.name);
    for (const EffectParameter& parameter : effect.parameters) {
      const bool force = effect.place == Place::velocity || effect.place == Place::state;
      if (!force) CHECK(parameter.measure.effort == 0);
      if (effect.place != Place::velocity && effect.place != Place::planar) CHECK(parameter.measure.position == 0);
      if (effect.place == Place::parameter) CHECK(parameter.measure.value == 0);
    }
  }
}

TEST_CASE("every effect does something, in the way of its place") {
  for (const Effect& effect : all_effects()) {
    CAPTURE(effect.name);
    const bool acts[] = {effect.force || effect.dry || effect.seen_position || effect.limit,
                         effect.force || effect.limit,
                         effect.signal || effect.delay,
                         static_cast<bool>(effect.sensor),
                         static_cast<bool>(effect.planar),
                         static_cast<bool>(effect.factor)};
    for (int place = 0; place < 6; ++place) {
      if (static_cast<int>(effect.place) == place) CHECK(acts[place]);
    }
    CHECK((effect.hidden_states > 0) == (effect.hidden_rate || effect.advance || effect.start));
  }
}

// What an effect does at a random context, with parameters p, as numbers; with one part of the context at zero.
std::vector<double> marks_of(const Effect& effect, const std::vector<double>& p, std::uint64_t seed,
                             double EffectContext::*none = nullptr) {
  Rng rng(seed);
  EffectContext m;
  for (double* field : {&m.time, &m.value, &m.position, &m.rate, &m.drive, &m.load, &m.damping}) {
    *field = 2 * rng.uniform() - 1;
  }
  if (none != nullptr) m.*none = 0;
  m.step = 0.001 + 0.009 * rng.uniform();
  m.effort = 0.1 + rng.uniform();
  std::vector<double> memory(static_cast<std::size_t>(effect.hidden_states), 0.0);
  if (effect.start) effect.start(m, p, memory);
  m.value += 0.1;
  m.position += 0.05;
  if (effect.advance) effect.advance(m, p, memory);
  std::vector<double> marks;
  if (effect.force) marks.push_back(effect.force(m, p, memory));
  if (effect.dry) marks.push_back(effect.dry(m, p));
  if (effect.signal) marks.push_back(effect.signal(m, p, memory) - m.value);
  if (effect.delay) marks.push_back(effect.delay(p));
  if (effect.seen_position) marks.push_back(effect.seen_position(m, p, memory) - m.position);
  if (effect.factor) marks.push_back(effect.factor(m, p) - 1);
  if (effect.sensor) {
    const std::vector<double> time = {0, 0.1, 0.15, 0.3}, truth = {0.3, -0.1, 0.7, 0.5};
    std::vector<double> readings = truth;
    effect.sensor({time, readings}, p);
    for (std::size_t i = 0; i < truth.size(); ++i) marks.push_back(readings[i] - truth[i]);
  }
  if (effect.planar) {
    const Pose2 step{m.value, m.position, m.rate}, moved = effect.planar(step, m.drive, p);
    marks.insert(marks.end(), {moved.x - step.x, moved.y - step.y, moved.angle - step.angle});
  }
  if (effect.limit) {
    double value = m.value, position = m.position, other = m.rate;
    effect.limit(p, value, position, other);
    marks.insert(marks.end(), {value - m.value, position - m.position, other - m.rate});
  }
  return marks;
}

TEST_CASE("without strength an effect changes nothing") {
  for (const Effect& effect : all_effects()) {
    CAPTURE(effect.name);
    CAPTURE(effect.form);
    std::vector<double> p;
    bool any = false;
    for (const EffectParameter& parameter : effect.parameters) {
      p.push_back(parameter.strength ? 1e-13 : parameter.starts.front());
      any = any || parameter.strength;
    }
    if (!any) continue;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      for (const double mark : marks_of(effect, p, seed)) CHECK(std::abs(mark) < 1e-10);
    }
  }
}

TEST_CASE("an effect asks for the parts of the force that it depends on, and for no others") {
  for (const Effect& effect : all_effects()) {
    if (effect.planar) continue;  // whose drive is the length of a step
    CAPTURE(effect.name);
    CAPTURE(effect.form);
    std::vector<double> p;
    for (const EffectParameter& parameter : effect.parameters) p.push_back((parameter.low + parameter.high) / 2);
    const auto depends_on = [&](double EffectContext::*part) {
      for (std::uint64_t seed = 0; seed < 50; ++seed) {
        if (marks_of(effect, p, seed) != marks_of(effect, p, seed, part)) return true;
      }
      return false;
    };
    CHECK(depends_on(&EffectContext::drive) == effect.needs_drive);
    CHECK(depends_on(&EffectContext::load) == effect.needs_load);
    CHECK(depends_on(&EffectContext::damping) == effect.needs_damping);
  }
}

TEST_CASE("within its bounds an effect stays finite") {
  for (const Effect& effect : all_effects()) {
    CAPTURE(effect.name);
    CAPTURE(effect.form);
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Rng rng(seed);
      std::vector<double> p;
      for (const EffectParameter& parameter : effect.parameters) {
        const double share = seed % 3 == 0 ? std::round(rng.uniform()) : rng.uniform();  // bounds themselves, too
        p.push_back(parameter.low + share * (parameter.high - parameter.low));
      }
      for (const double mark : marks_of(effect, p, seed + 1000)) CHECK(std::isfinite(mark));
    }
  }
}

}  // namespace
}  // namespace surefoot

// Effects of a run, sorted by what they do.
#include "surefoot/diagnose/simulation/effect_slots.hpp"

#include <doctest/doctest.h>

#include <memory>
#include <vector>

#include "surefoot/core/error.hpp"
#include "surefoot/diagnose/effects/backlash.hpp"
#include "surefoot/diagnose/effects/coulomb_friction.hpp"
#include "surefoot/diagnose/effects/dead_zone.hpp"
#include "surefoot/diagnose/effects/input_delay.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

EffectSlots slots_of(const std::vector<AttachedEffect>& effects) {
  const SimulatorInfo info = toys::SlidingBlock{}.info();
  const Recording recording = toys::blank_recording(info, 10, 0.1);
  Eigen::VectorXd p(3);
  p << 2, 0, 0;
  const SimulatorStructure structure = find_structure(toys::SlidingBlock{}, info, recording, recording, p);
  const std::vector<Eigen::VectorXd> values(effects.size(), Eigen::VectorXd::Zero(2));
  return assign_slots({effects, values}, info, structure, unit_sizes(info));
}

AttachedEffect attached(const Effect& effect, int at) {
  return {std::make_shared<const Effect>(effect), at, -1, "", 0};
}

TEST_CASE("without effects the rates are those of the simulator") {
  const EffectSlots slots = slots_of({});
  CHECK(slots.plain_rates);
  CHECK(slots.hidden == 0);
}

TEST_CASE("an effect stands wherever it does something, with the position that its velocity belongs to") {
  const EffectSlots slots = slots_of({attached(effects::coulomb_friction(), 1), attached(effects::dead_zone(), 0)});
  REQUIRE(slots.dry.size() == 1);
  CHECK(slots.dry[0].at == 1);
  CHECK(slots.dry[0].position == 0);
  CHECK(slots.commands.size() == 1);
  CHECK(slots.commands[0].number == 1);
  CHECK(slots.delays.empty());
  CHECK_FALSE(slots.plain_rates);
}

TEST_CASE("a delay alone leaves the rates as they are") {
  const EffectSlots slots = slots_of({attached(effects::input_delay(), 0)});
  CHECK(slots.delays.size() == 1);
  CHECK(slots.plain_rates);
}

TEST_CASE("hidden states follow each other, up to as many as there is room for") {
  const Effect backlash = effects::backlash();
  const EffectSlots slots = slots_of({attached(backlash, 1), attached(backlash, 1)});
  REQUIRE(slots.seen.size() == 2);
  CHECK(slots.seen[0].begin == 0);
  CHECK(slots.seen[1].begin == backlash.hidden_states);
  CHECK(slots.hidden == 2 * backlash.hidden_states);
  Effect large = backlash;
  large.hidden_states = most_hidden;
  CHECK_THROWS_AS(slots_of({attached(large, 1), attached(backlash, 1)}), DiagnoseError);
}

}  // namespace
}  // namespace surefoot::diagnosis

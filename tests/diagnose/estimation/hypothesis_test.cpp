// Hypotheses: their variables, sizes and units.
#include "surefoot/diagnose/estimation/hypothesis.hpp"

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/named_effect.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::LeakyTank;
using toys::SlidingBlock;

TEST_CASE("variables are free parameters, effects and unknown initial states, as far as a fit may change them") {
  Recording recording = toys::tank_recording(0, 50);
  recording.initial_scale[0] = 0.1;
  const BoundSimulator bound = bind_simulator(LeakyTank{}, {recording});
  Hypothesis hypothesis = nominal_hypothesis(bound);
  hypothesis.effects.push_back(attach(bound.info, {"constant_rate", "level", {}, {}, {0.1}}, all_effects()));
  hypothesis.values.push_back(Vec<1>(0.1));
  const auto kinds = [&](Free free) {
    std::string text;
    for (const Variable& one : variables_of(bound, hypothesis, {0}, free)) text += "pei"[static_cast<int>(one.kind)];
    return text;
  };
  CHECK(kinds(Free::everything) == "ppei");
  CHECK(kinds(Free::all_but_effects) == "ppi");
  CHECK(kinds(Free::initial_only) == "i");
  for (const Variable& one : variables_of(bound, hypothesis, {0})) {
    CHECK(from_search(one, to_search(one, value_of(hypothesis, one))) ==
          doctest::Approx(value_of(hypothesis, one)).epsilon(1e-12));
    CHECK(from_search(one, 1e9) == one.high);
  }
}

TEST_CASE("what follows an input begins within the range of that input") {
  Recording recording = toys::tank_recording(0, 50);
  recording.inputs.setConstant(0.3);
  recording.inputs(0, 20) = 0.5;
  BoundSimulator bound = bind_simulator(LeakyTank{}, {recording});
  Hypothesis hypothesis = nominal_hypothesis(bound);
  const std::string input = bound.info.inputs[0].name;
  hypothesis.effects.push_back(attach(bound.info, {"rate_limit", input, "not settled", {}, {1}}, all_effects()));
  hypothesis.values.push_back(Eigen::VectorXd::Ones(2));
  bound.sizes = measure_sizes(bound, hypothesis, {0}, simulate_all(bound, hypothesis, {0}, {}, serially()));
  const std::vector<Variable> variables = variables_of(bound, hypothesis, {0}, Free::initial_only);
  REQUIRE(variables.size() == 1);
  CHECK(variables[0].kind == Variable::Kind::start);
  CHECK(variables[0].low == doctest::Approx(-0.3));  // from its first value down to nothing
  CHECK(variables[0].high == doctest::Approx(0.2));
}

TEST_CASE("units of an effect's parameters are those of what it is attached to") {
  const BoundSimulator block = bind_simulator(SlidingBlock{}, {toys::blank_recording(SlidingBlock{}.info(), 10, 0.1)});
  const AttachedEffect friction = attach(block.info, {"coulomb_friction", "v", {}, {}, {1}}, all_effects());
  CHECK(measure_unit(block, friction, {.effort = 1}) == "N");
  CHECK(measure_unit(block, friction, {.effort = 1, .value = -1}) == "N/(m/s)");
  CHECK(measure_unit(block, friction, {}) == "1");
  BoundSimulator sized = block;
  sized.sizes.effort[1] = 6;
  sized.sizes.state[1] = 2;
  CHECK(measure_size(sized, friction, {.effort = 1, .value = -1}) == doctest::Approx(3));
}

TEST_CASE("bounds that are given with an effect stand in place of those of the library") {
  const BoundSimulator bound = bind_simulator(LeakyTank{}, {toys::tank_recording(0, 50)});
  const auto range_with = [&](const EffectBounds& bounds) {
    Hypothesis hypothesis = nominal_hypothesis(bound);
    const NamedEffect named{"constant_rate", "level", {}, {}, {0.1}, {bounds}};
    hypothesis.effects.push_back(attach(bound.info, named, all_effects()));
    hypothesis.values.push_back(Vec<1>(0.1));
    std::vector<std::pair<double, double>> ranges;
    for (const Variable& one : variables_of(bound, hypothesis, {0})) {
      if (one.kind == Variable::Kind::effect) ranges.emplace_back(one.low, one.high);
    }
    return ranges;
  };
  const auto library = range_with({});
  REQUIRE(library.size() == 1);
  CHECK(library[0].first < 0);
  CHECK(range_with({0.05, 1e3}) == std::vector<std::pair<double, double>>{{0.05, 1e3}});
  CHECK(range_with({0.1, 0.1}).empty());  // it is not fitted
}

}  // namespace
}  // namespace surefoot::diagnosis

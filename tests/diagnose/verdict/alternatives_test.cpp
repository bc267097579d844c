// Alternatives: what may stand in an effect's place.
#include "surefoot/diagnose/verdict/alternatives.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::diagnosis {
namespace {

const SelectionCriteria tie_criteria;

// Effects at the first state, with a root mean square error.
EvaluatedHypothesis with_effects_named(const std::vector<std::string>& names, double error = 1) {
  EvaluatedHypothesis one;
  for (const std::string& name : names) {
    Effect effect;
    effect.name = name;
    one.hypothesis.effects.push_back({std::make_shared<const Effect>(effect), 0, -1, "level", 0});
    one.hypothesis.values.emplace_back(Eigen::VectorXd::Zero(1));
  }
  one.errors = {Eigen::MatrixXd::Constant(1, 1, error * error), Eigen::MatrixXd::Constant(1, 1, 100),
                Eigen::VectorXd::Ones(1)};
  return one;
}

// A choice and what might have been chosen instead, with probabilities.
Selection choice_of(const std::vector<std::string>& chosen, double probability,
                    const std::vector<std::pair<std::vector<std::string>, double>>& alternatives) {
  Selection selection;
  selection.nominal = with_effects_named({}, 9);
  selection.chosen = with_effects_named(chosen);
  selection.probability = probability;
  for (const auto& [names, share] : alternatives) {
    selection.alternatives.push_back(with_effects_named(names, 2));
    selection.alternative_probabilities.push_back(share);
  }
  return selection;
}

TEST_CASE("effects are named with their places, in words") {
  CHECK(names_of({}) == "no effect at all");
  const Hypothesis two = with_effects_named({"input_delay", "lag"}).hypothesis;
  CHECK(names_of(two) == "input delay at level and lag at level");
  CHECK(names_of(two, 1) == "lag at level");
}

TEST_CASE("what is not much less probable than the choice cannot be told from it") {
  const double chosen = 0.6, limit = chosen / tie_criteria.tie_odds;
  const Alternatives found = find_alternatives(
      choice_of({"lag"}, chosen, {{{"delay"}, 1.01 * limit}, {{"drift"}, 0.99 * limit}, {{}, 0.1}}), tie_criteria);
  REQUIRE(found.list.size() == 2);  // and no effect at all is no alternative
  CHECK(found.list[0].effects.front() == std::pair<std::string, std::string>{"delay", "level"});
  CHECK(found.list[0].probability == 1.01 * limit);
  CHECK(found.list[0].fitted_rmse == doctest::Approx(2));
  CHECK(found.list[0].indistinguishable);
  CHECK_FALSE(found.list[1].indistinguishable);
  CHECK(found.ties == std::vector<std::string>{"delay at level"});
  REQUIRE(found.indistinguishable.size() == 1);
  CHECK(found.indistinguishable.front().hypothesis.effects.front().effect->name == "delay");
}

TEST_CASE("a part of the choice that cannot be told from it is named as that part alone") {
  const Alternatives found =
      find_alternatives(choice_of({"lag", "delay"}, 0.5, {{{"lag"}, 0.3}, {{"drift"}, 0.2}}), tie_criteria);
  CHECK(found.ties == std::vector<std::string>{"lag at level alone", "drift at level"});
}

TEST_CASE("where nothing was chosen nothing is a tie") {
  const Alternatives found = find_alternatives(choice_of({}, 0.5, {{{"lag"}, 0.5}}), tie_criteria);
  REQUIRE(found.list.size() == 1);
  CHECK_FALSE(found.list[0].indistinguishable);
  CHECK(found.ties.empty());
}

TEST_CASE("effects that were known before are no part of an alternative") {
  Selection selection = choice_of({"leak", "lag"}, 0.6, {{{"leak", "delay"}, 0.3}, {{"leak"}, 0.1}});
  selection.nominal = with_effects_named({"leak"});
  const Alternatives found = find_alternatives(selection, tie_criteria);
  REQUIRE(found.list.size() == 1);
  REQUIRE(found.list[0].effects.size() == 1);
  CHECK(found.list[0].effects[0].first == "delay");
  CHECK(found.ties == std::vector<std::string>{"delay at level"});
}

TEST_CASE("no more alternatives are told than anyone reads, the most probable ones") {
  std::vector<std::pair<std::vector<std::string>, double>> many;
  for (int k = 0; k < 100; ++k) many.push_back({{"lag " + std::to_string(k)}, 0.01});
  const Alternatives found = find_alternatives(choice_of({"lag"}, 0.5, many), tie_criteria);
  CHECK(found.list.size() < 50);
  CHECK(found.list.at(0).effects[0].first == "lag 0");
}

TEST_CASE("an effect is as probable as all structures together that it is part of") {
  Selection selection = choice_of({"lag", "leak"}, 0.5, {{{"lag"}, 0.2}, {{"leak", "delay"}, 0.15}, {{"drift"}, 0.1}});
  selection.evidence = {{.gain = 0.4, .stderr_ = 0.02, .t = 20, .p_value = 0.003}};
  const Evidence lag = evidence_for(selection, 0), leak = evidence_for(selection, 1);
  CHECK(lag.gain == 0.4);
  CHECK(lag.gain_stderr == 0.02);
  CHECK(lag.p_value == 0.003);
  CHECK(lag.confidence == doctest::Approx(0.7));
  CHECK(leak.confidence == doctest::Approx(0.65));
  CHECK(leak.p_value == 1);  // never compared: no evidence
  selection.nominal = with_effects_named({"lag"});
  CHECK(evidence_for(selection, 0).confidence == doctest::Approx(0.65));  // lag was known before
}

TEST_CASE("the same effect at another place is another one") {
  Selection selection = choice_of({"lag"}, 0.5, {{{"lag"}, 0.3}});
  selection.alternatives[0].hypothesis.effects[0].at = 1;
  CHECK(evidence_for(selection, 0).confidence == doctest::Approx(0.5));
}

}  // namespace
}  // namespace surefoot::diagnosis

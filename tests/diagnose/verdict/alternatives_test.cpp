// Alternatives: what may stand in an effect's place.
#include "surefoot/diagnose/verdict/alternatives.hpp"

#include <doctest/doctest.h>

#include <memory>

#include "surefoot/diagnose/effects/catalogue.hpp"

namespace surefoot::diagnosis {
namespace {

const AlternativeCriteria alternative_criteria;

// Attached to the first state, with losses that differ from block to block by a tenth.
EvaluatedHypothesis with_effect(const std::string& name, double loss, int turn = 0) {
  EvaluatedHypothesis one;
  if (!name.empty()) {
    Effect effect;
    effect.name = name;
    one.hypothesis.effects.push_back({std::make_shared<const Effect>(effect), 0, -1, "level", 0});
    one.hypothesis.values.emplace_back(Eigen::VectorXd::Zero(1));
  }
  for (int block = 0; block < 24; ++block) {
    one.cross_validated.blocks.push_back(loss * (1 + 0.05 * ((block + turn) % 3)));
    one.cross_validated.counts.push_back(60);
  }
  return one;
}

Selection selection_of(const EvaluatedHypothesis& chosen, std::vector<EvaluatedHypothesis> alternatives) {
  Selection selection;
  selection.nominal = with_effect("", 100);
  selection.chosen = chosen;
  selection.alternatives = std::move(alternatives);
  selection.candidates = 10;
  return selection;
}

TEST_CASE("what the choice is far ahead of, or surely ahead of, can be told from it") {
  CHECK_FALSE(indistinguishable({.gain = 0.11, .t = 1}, 0.8, 0.5, alternative_criteria));
  CHECK_FALSE(indistinguishable({.gain = 0.05, .t = 3}, 0.8, 0.5, alternative_criteria));
  CHECK(indistinguishable({.gain = 0.05, .t = 1}, 0.8, 0.5, alternative_criteria));
  CHECK(indistinguishable({.gain = 0.009, .t = 30}, 0.8, 0.5, alternative_criteria));
}

TEST_CASE("what has nearly all of the gain is a tie, however surely the choice is ahead") {
  CHECK(indistinguishable({.gain = 0.2, .t = 20}, 0.9, 0.88, alternative_criteria));
  CHECK_FALSE(indistinguishable({.gain = 0.2, .t = 20}, 0.9, 0.87, alternative_criteria));
}

TEST_CASE("alternatives are listed from the best on, without other forms of the choice") {
  const Alternatives found = find_alternatives(selection_of(
      with_effect("lag", 1), {with_effect("drift", 50), with_effect("delay", 1.001, 1), with_effect("lag", 1.1)}));
  REQUIRE(found.list.size() == 2);
  CHECK(found.list[0].effects.front().first == "delay");
  CHECK(found.list[0].indistinguishable);
  CHECK(found.list[1].effects.front().first == "drift");
  CHECK_FALSE(found.list[1].indistinguishable);
  CHECK(found.ties == std::vector<std::string>{"delay at level"});
  CHECK(found.indistinguishable.front().hypothesis.effects.front().effect->name == "delay");
}

TEST_CASE("where nothing was chosen nothing is a tie") {
  const Alternatives found = find_alternatives(selection_of(with_effect("", 100), {with_effect("lag", 100)}));
  REQUIRE(found.list.size() == 1);
  CHECK_FALSE(found.list[0].indistinguishable);
  CHECK(found.ties.empty());
}

TEST_CASE("the bootstrap is sure of what is better in every block, and of nothing between equals") {
  const EvaluatedHypothesis good = with_effect("lag", 1), twin = with_effect("delay", 1.0, 1),
                            bad = with_effect("drift", 9);
  const BlockLosses parent = with_effect("", 100).cross_validated;
  CHECK(bootstrap_confidence(good, parent, {bad}, 1) == 1);
  CHECK(bootstrap_confidence(bad, parent, {good}, 1) == 0);
  const double undecided = bootstrap_confidence(good, parent, {twin}, 1);
  CHECK(undecided > 0.2);
  CHECK(undecided < 0.8);
  CHECK(bootstrap_confidence(good, parent, {twin}, 1) == undecided);  // the same seed
}

TEST_CASE("an alternative with more parameters has to be better by one per cent") {
  EvaluatedHypothesis longer = with_effect("backlash", 0.995);
  longer.hypothesis.values[0] = Eigen::VectorXd::Zero(3);
  const BlockLosses parent = with_effect("", 100).cross_validated;
  CHECK(bootstrap_confidence(with_effect("lag", 1), parent, {longer}, 1) == 1);
  CHECK(bootstrap_confidence(with_effect("lag", 1), parent, {with_effect("delay", 0.995)}, 1) == 0);
}

TEST_CASE("evidence pays for the number of candidates, and rivals with other counts of effects are left out") {
  Selection selection = selection_of(with_effect("lag", 1), {with_effect("drift", 9)});
  EvaluatedHypothesis pair = with_effect("drift", 0.1);
  pair.hypothesis.effects.push_back(pair.hypothesis.effects.front());
  selection.alternatives.push_back(pair);
  selection.evidence = {{.gain = 0.4, .stderr_ = 0.02, .t = 20, .p_value = 0.003}};
  const Evidence evidence = evidence_for(selection, 0, 1);
  CHECK(evidence.gain == 0.4);
  CHECK(evidence.p_value == doctest::Approx(0.03));
  CHECK(evidence.confidence == 1);
  CHECK(evidence_for(selection, 1, 1).p_value == 1);  // never compared: no evidence
}

}  // namespace
}  // namespace surefoot::diagnosis

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "score/compare.hpp"
#include "score/reliability.hpp"
#include "score/table.hpp"

namespace {

using score::Answer;
using score::Effect;
using score::Truth;

Truth friction_and(const std::vector<Effect>& more = {}) {
  Truth truth;
  truth.kind = more.empty() ? "one" : "two";
  truth.effects = {{"coulomb_friction", "v", {"x"}, {{"dead_zone", "push"}}}};
  truth.effects.insert(truth.effects.end(), more.begin(), more.end());
  truth.noise = {{"x_m", 0.5}};
  truth.rmse = {{"rec_1.csv", 1.0}};
  truth.floor = truth.rmse;
  truth.calibrated = {{"rec_1.csv", 4.0}};
  return truth;
}

Answer naming(const std::vector<Effect>& effects, double rmse_after = 0.5) {
  Answer answer;
  answer.verdict = "missing-physics";
  answer.effects = effects;
  answer.test = {"rec_1.csv"};
  answer.rmse_after = {{"x_m", rmse_after}};
  return answer;
}

}  // namespace

TEST_CASE("a structure is right with all names and places and nothing more; equivalent descriptions count") {
  const Truth truth = friction_and();
  CHECK(score::is_right_structure(truth, {{"coulomb_friction", "v"}}));
  CHECK(score::is_right_structure(truth, {{"coulomb_friction", "x"}}));
  CHECK(score::is_right_structure(truth, {{"dead_zone", "push"}}));
  CHECK_FALSE(score::is_right_structure(truth, {{"coulomb_friction", "w"}}));
  CHECK_FALSE(score::is_right_structure(truth, {{"dead_zone", "duty"}}));
  CHECK_FALSE(score::is_right_structure(truth, {{"coulomb_friction", "v"}, {"leak", "h"}}));
  CHECK_FALSE(score::is_right_structure(truth, {}));
  const Truth two = friction_and({{"leak", "h"}});
  CHECK(score::is_right_structure(two, {{"leak", "h"}, {"coulomb_friction", "v"}}));
  CHECK_FALSE(score::is_right_structure(two, {{"coulomb_friction", "v"}}));
  Truth nothing;
  nothing.kind = "nothing";
  CHECK(score::is_right_structure(nothing, {}));
}

TEST_CASE("a declared class counts as right when it holds the truth, and its size is told") {
  Answer answer = naming({{"hysteresis", "v"}});
  answer.alternatives = {{{{"coulomb_friction", "v"}}, false}};
  CHECK_FALSE(score::compare(friction_and(), answer).structure_right);
  answer.alternatives[0].indistinguishable = true;
  const Truth truth = friction_and();
  const score::Outcome outcome = score::compare(truth, answer);
  CHECK(outcome.structure_right);
  CHECK(outcome.class_size == 2);
}

TEST_CASE("a verdict that explains away what is above the noise is counted") {
  const Truth truth = friction_and();
  CHECK_FALSE(score::compare(truth, naming({{"coulomb_friction", "v"}}, 0.6)).against_noise);
  CHECK(score::compare(truth, naming({{"coulomb_friction", "v"}}, 0.9)).against_noise);
  Answer honest = naming({}, 0.9);
  honest.verdict = "unexplained";
  CHECK_FALSE(score::compare(truth, honest).against_noise);
}

TEST_CASE("probabilities are compared with shares of right structures") {
  std::vector<score::Statement> statements;
  for (int i = 0; i < 100; ++i) statements.push_back({0.75, i < 75});
  CHECK(score::expected_calibration_error(score::bins_of(statements)) == doctest::Approx(0));
  for (int i = 0; i < 100; ++i) statements.push_back({0.95, i < 55});
  const auto bins = score::bins_of(statements);
  REQUIRE(bins.size() == 2);
  CHECK(bins[1].share_right == doctest::Approx(0.55));
  CHECK(score::expected_calibration_error(bins) == doctest::Approx(0.2));
  CHECK(std::isnan(score::expected_calibration_error({})));
}

TEST_CASE("answers state probabilities in a list of structures, or beside choice and alternatives") {
  const auto file = std::filesystem::temp_directory_path() / "surefoot_blind_answer.json";
  const auto read = [&](const char* json) {
    std::ofstream(file) << json;
    return score::read_answer(file);
  };
  const auto listed = read(R"({"verdict": "missing_physics", "noise_ratio": 1.1, "effects": [], "structures": [
    {"effects": [{"name": "leak", "place": "h"}], "probability": 0.8}, {"effects": [], "probability": 0.2}]})");
  REQUIRE(listed->structures.size() == 2);
  CHECK(listed->structures[0].effects[0].attached_to == "h");
  CHECK(listed->structures[1].probability == 0.2);
  CHECK(listed->noise_ratio == 1.1);
  const auto beside = read(R"({"verdict": "missing-physics", "alternatives": [
    {"effects": [{"name": "hysteresis"}], "probability": 0.3}],
    "effects": [{"name": "leak", "attached_to": "h", "probability": 0.7}]})");
  REQUIRE(beside->structures.size() == 2);
  CHECK(beside->structures[0].probability == 0.7);
  CHECK(beside->structures[1].effects[0].name == "hysteresis");
  const auto silent = read(R"({"verdict": "adequate", "effects": []})");
  CHECK(silent->structures.empty());
  CHECK(std::isnan(silent->noise_ratio));
  std::filesystem::remove(file);
}

TEST_CASE("parameters are compared at the place itself, not with those of an equivalent") {
  Truth truth = friction_and();
  truth.effects[0].same_formula = true;
  truth.effects[0].parameters = {{"level", 2.0}};
  truth.effects[0].equivalents = {{"coulomb_friction", "duty"}};
  const auto errors = [&](const std::string& place) {
    Effect effect{"coulomb_friction", place};
    effect.parameters = {{"level", 2.2}};
    return score::compare(truth, naming({effect})).parameter_errors;
  };
  REQUIRE(errors("v").size() == 1);
  CHECK(errors("v")[0] == doctest::Approx(0.1));
  CHECK(errors("duty").empty());
}

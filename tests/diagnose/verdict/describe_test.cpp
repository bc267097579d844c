// Descriptions: values with intervals, and sentences.
#include "surefoot/diagnose/verdict/describe.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <string>

#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

BoundSimulator tank() { return bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 50)}); }

// Errors of the two parameters of a tank.
StandardErrors errors_of(double gain, double leak, double correlation) {
  StandardErrors errors;
  errors.variables = {{Variable::Kind::parameter, 0, 0, 0.2, 5, 1, true},
                      {Variable::Kind::parameter, 1, 0, 0.2, 5, 1, true}};
  errors.deviation = Vec<2>(gain, leak);
  errors.correlation = Eigen::Matrix2d{{1, correlation}, {correlation, 1}};
  return errors;
}

TEST_CASE("intervals are two-sided 95 % of the standard errors, within the bounds") {
  const BoundSimulator bound = tank();
  const auto parameters = calibrated_parameters(bound, nominal_hypothesis(bound), errors_of(0.1, 1, 0));
  REQUIRE(parameters.size() == 2);
  CHECK(parameters[0].fit.low == doctest::Approx(std::exp(-0.196)));  // searched by its logarithm
  CHECK(parameters[0].fit.high == doctest::Approx(std::exp(0.196)));
  CHECK(parameters[1].fit.low == 0.2);
  CHECK_FALSE(parameters[0].at_bound);
}

TEST_CASE("a parameter that was fitted to its bound is said to be there") {
  const BoundSimulator bound = tank();
  Hypothesis hypothesis = nominal_hypothesis(bound);
  hypothesis.parameters = Vec<2>(5, 0.2);
  for (const CalibratedParameter& one : calibrated_parameters(bound, hypothesis, errors_of(0.1, 0.1, 0))) {
    CHECK(one.at_bound);
  }
}

TEST_CASE("pairs of parameters are named if the recordings hardly separate them") {
  CHECK(correlated_pairs(tank(), errors_of(1, 1, 0.94)).empty());
  CHECK(correlated_pairs(tank(), errors_of(1, 1, -0.96)) ==
        std::vector<std::string>{"gain and leak (correlation -0.96)"});
}

TEST_CASE("an effect is described with its values, its units and its place") {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks({}, 0.01));
  const Hypothesis hypothesis = toys::with_effects(setup, {{"constant_rate", "level", {}, {}, {0.2}}});
  StandardErrors errors = errors_of(0.1, 0.1, 0);
  errors.variables = {{Variable::Kind::effect, 0, 0, -1, 1, 1, false}};
  errors.deviation = Vec<1>(0.01);
  const FoundEffect found = describe(setup.bound, hypothesis, 0, &errors);
  CHECK(found.name == "constant_rate");
  CHECK(found.attached_to == "level");
  REQUIRE(found.parameters.size() == 1);
  CHECK(found.parameters[0].unit == "m/s");
  CHECK(found.parameters[0].high == doctest::Approx(0.2 + 0.0196));
  CHECK(found.parameters[0].least == -1);
  CHECK(found.parameters[0].most == 1);
  CHECK(found.sentence.find("0.2 m/s") != std::string::npos);
  CHECK(describe(setup.bound, hypothesis, 0, nullptr).parameters[0].high == 0.2);
}

TEST_CASE("every verdict has its sentence") {
  Diagnosis diagnosis;
  diagnosis.held_out_before = 2;
  diagnosis.held_out_after = 0.5;
  diagnosis.noise_ratio = 1.2;
  diagnosis.per_recording = {{"a", 3, 0.1}, {"b", 0.6, 0.7}};
  diagnosis.channels.resize(2);
  diagnosis.channels[0].noise_stated = true;
  CHECK(verdict_sentence(diagnosis, {}).ends_with("to 1.2 times the noise as estimated."));
  diagnosis.channels[1].noise_stated = true;
  CHECK(verdict_sentence(diagnosis, {}).ends_with("to 1.2 times the noise."));
  diagnosis.channels[0].noise_amplification = 1.4;
  CHECK(verdict_sentence(diagnosis, {}).ends_with("to 1.2 times what the noise leaves of predictions."));
  diagnosis.channels[0].noise_amplification = 1;
  CHECK(verdict_sentence(diagnosis, {}).find("with its nominal parameters") != std::string::npos);
  diagnosis.verdict = Verdict::parameters_only;
  CHECK(verdict_sentence(diagnosis, {"lag"}).find("with calibrated parameters") != std::string::npos);
  FoundEffect effect;
  effect.sentence = "a leak";
  diagnosis.effects = {effect};
  diagnosis.verdict = Verdict::missing_physics;
  CHECK(verdict_sentence(diagnosis, {"lag"}) ==
        "Left out of the model: a leak. With that, the error on held-out recordings falls by 75 %, to 1.2 times the "
        "noise; 1 of 2 agree. These recordings cannot tell it from lag.");
  diagnosis.verdict = Verdict::unexplained;
  diagnosis.noise_ratio = 4;
  diagnosis.regions = {{.rule = "level > 2 m"}};
  CHECK(verdict_sentence(diagnosis, {}) ==
        "The model leaves something out that no known effect explains; a part of it: a leak; it shows where level > 2 "
        "m. With that, the error on held-out recordings falls by 75 %, to 4 times the noise; 1 of 2 agree.");
  diagnosis.held_out_after = 2.02;
  CHECK(verdict_sentence(diagnosis, {}).find("error on held-out recordings rises by 1 %") != std::string::npos);
  diagnosis.held_out_after = 0.5;
  diagnosis.verdict = Verdict::unfinished;
  CHECK(verdict_sentence(diagnosis, {}).starts_with("The search was not finished, so that nothing is concluded; the"));
  CHECK(verdict_sentence(diagnosis, {}).ends_with(" It needs more time (max_seconds, --budget)."));
  diagnosis.noise_ratio = 1.2;
  CHECK(verdict_sentence(diagnosis, {}).starts_with(
      "The search was not finished, so that others may explain it as well as what was found: a leak."));
  diagnosis.noise_ratio = 4;
  diagnosis.effects.clear();
  diagnosis.verdict = Verdict::unexplained;
  CHECK(verdict_sentence(diagnosis, {}).ends_with("Its error is 4 times the noise."));
}

TEST_CASE("only an unstable machine, and no chaotic motion, is said to lack its controller") {
  CHECK(following_sentence(20, true).find("controller") == std::string::npos);
  CHECK(following_sentence(20, false).find("unstable without its controller") != std::string::npos);
}

TEST_CASE("where nothing is named, the structure that comes clearly nearest is told") {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::unexplained;
  diagnosis.held_out_before = 2;
  Alternative little, much, unknown;
  little.effects = {{"sensor_bias", "level_m"}};
  little.held_out_rmse = 1.7;
  much.effects = {{"overflow", "level_1"}, {"leak", "level_2"}};
  much.held_out_rmse = 1;
  unknown.effects = {{"backlash", "level_m"}};
  diagnosis.alternatives = {little, unknown};
  CHECK(verdict_sentence(diagnosis, {}).find("nearest") == std::string::npos);
  diagnosis.alternatives = {little, much, unknown};
  CHECK(verdict_sentence(diagnosis, {})
            .ends_with(" What comes nearest is overflow at level_1 and leak at level_2: with that the error on "
                       "held-out recordings would "
                       "fall by 50 %, but too few of them show it to be sure."));
  diagnosis.effects.resize(1);
  CHECK(verdict_sentence(diagnosis, {}).find("nearest") == std::string::npos);
}

TEST_CASE("recordings that are further off than noise explains are named, three of them at most") {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::unexplained;
  diagnosis.per_recording = {{"a", 1, 1}, {"b", 9, 9, 9, 100, true}};
  CHECK(verdict_sentence(diagnosis, {}).ends_with(" 1 of 2 recordings is further off than noise explains: b."));
  diagnosis.effects.resize(1);
  CHECK(verdict_sentence(diagnosis, {"lag"}).find("explains: b. These recordings cannot tell") != std::string::npos);
  for (const char* name : {"c", "d", "e"}) diagnosis.per_recording.push_back({name, 9, 9, 9, 100, true});
  const std::string many = verdict_sentence(diagnosis, {});
  CHECK(many.find("4 of 5 recordings") != std::string::npos);
  CHECK(many.find("explains: b, c and d and others") != std::string::npos);
}

TEST_CASE("outputs that leave far less than their stated noise are named") {
  std::vector<ChannelMismatch> outputs(2);
  outputs[0].output = "level_m";
  outputs[0].unit = "m";
  outputs[0].noise = 0.02;
  outputs[0].rmse_after = 0.004;
  outputs[1].noise = outputs[1].rmse_after = 1;
  CHECK(overstated_noise_sentence(outputs).empty());  // estimated
  outputs[0].noise_stated = outputs[1].noise_stated = true;
  CHECK(overstated_noise_sentence(outputs).find("of level_m (0.004 m of 0.02 m):") != std::string::npos);
  outputs[0].rmse_after = 0.018;
  CHECK(overstated_noise_sentence(outputs).empty());
}

TEST_CASE("of all that cannot be told from the choice three are named in the sentence") {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::missing_physics;
  CHECK(verdict_sentence(diagnosis, {"a", "b", "c"}).ends_with("cannot tell it from a; or from b; or from c."));
  CHECK(verdict_sentence(diagnosis, {"a", "b", "c", "d"}).ends_with("or from c; or from others."));
}

TEST_CASE("the next experiment shows one effect, or the other if it has its own") {
  const auto one = [](const std::string& name, const std::string& experiment) {
    Effect effect;
    effect.name = name;
    effect.experiment = experiment;
    Hypothesis hypothesis;
    hypothesis.effects.push_back({std::make_shared<const Effect>(effect), 0, -1, "level", 0});
    return hypothesis;
  };
  CHECK(next_experiment(one("lag", "step the input"), one("delay", "send pulses")) ==
        "step the input: separates lag from delay; or send pulses");
  CHECK(next_experiment(one("lag", "step the input"), one("delay", "step the input")) ==
        "step the input: separates lag from delay");
  Hypothesis both = one("lag", "step the input");
  both.effects.push_back(one("leak", "wait").effects.front());
  Hypothesis other = one("delay", "send pulses");
  other.effects.push_back(both.effects.back());
  CHECK(next_experiment(both, other) == "step the input: separates lag from delay; or send pulses");  // both leak
  CHECK(next_experiment(both, one("lag", "step the input")) == "wait: separates leak from lag; or step the input");
  CHECK(next_experiment(one("lag", "step the input"), one("lag", "step the input")) == "step the input");
}

TEST_CASE("each kind of noise is told apart") {
  CHECK(noise_sentence(NoiseKind::measurement) != noise_sentence(NoiseKind::process));
  CHECK(noise_sentence(NoiseKind::process) != noise_sentence(NoiseKind::final_pose));
}

}  // namespace
}  // namespace surefoot::diagnosis

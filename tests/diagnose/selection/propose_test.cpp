// Proposals: which effects may attach where, and how they are ranked before anything is fitted.
#include "surefoot/diagnose/selection/propose.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/constant_force.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/servo_pendulum.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::ServoPendulum;

// Two recordings of a servo with these effects, the right parameters, and the sizes of the model's own motion.
struct Bench {
  BoundSimulator bound;
  Hypothesis base;
  FitProblem problem;
  std::vector<SimulatedRun> runs;
};
Bench bench(const std::vector<NamedEffect>& effects) {
  Bench b{bind_simulator(ServoPendulum{}, toys::servo_recordings(toys::machine({}, effects), 2, 1)), {}, {}, {}};
  b.base = nominal_hypothesis(b.bound);
  b.problem.recordings = {0, 1};
  b.runs = simulate_all(b.bound, b.base, {0, 1}, {}, serially());
  b.problem.weighting.sigma = residual_sizes(b.bound, {0, 1}, b.runs);
  b.bound.sizes = measure_sizes(b.bound, b.base, {0, 1}, b.runs);
  return b;
}

std::vector<std::string> labels(const std::vector<AttachedEffect>& attached) {
  std::vector<std::string> result;
  for (const AttachedEffect& one : attached) result.push_back(one.label());
  return result;
}
bool has(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

TEST_CASE("effects attach where they make sense, and nowhere else") {
  const Bench b = bench({});
  const auto distinct = distinct_inputs(b.bound, b.base, {0, 1}, b.runs);
  CHECK(distinct == std::vector<bool>{true, true, true});
  const auto places = labels(attachments(b.bound, all_effects(), distinct));
  for (const char* there :
       {"coulomb_friction at omega", "backlash at omega", "input_delay at goal", "input_delay at duty",
        "dead_zone at duty", "sensor_bias at theta_rad", "parameter_drift at armature"}) {
    CHECK(has(places, there));
  }
  for (const char* absent : {"coulomb_friction at theta", "leak at theta", "leak at omega", "body_drift at planar"}) {
    CHECK_FALSE(has(places, absent));
  }
}

TEST_CASE("parameters that are fixed do not drift") {
  Bench b = bench({});
  b.bound.info.parameters[2].fixed = true;
  CHECK_FALSE(has(labels(attachments(b.bound, all_effects(), {true, true, true})), "parameter_drift at armature"));
}

TEST_CASE("a signal that is a multiple of an input is left to the input, and inputs that never change are left out") {
  std::vector<Recording> recordings{toys::tank_recording(0, 100), toys::tank_recording(1, 100)};
  const auto distinct = [](const std::vector<Recording>& of) {
    const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, of);
    const Hypothesis base = nominal_hypothesis(bound);
    return distinct_inputs(bound, base, {0, 1}, simulate_all(bound, base, {0, 1}, {}, serially()));
  };
  CHECK(distinct(recordings) == std::vector<bool>{true, false});
  for (Recording& recording : recordings) recording.inputs.setConstant(0.5);
  CHECK(distinct(recordings) == std::vector<bool>{false, false});
}

TEST_CASE("what really is missing ranks high, and starts near its truth") {
  const Bench b = bench({{"constant_force", "omega", {}, {}, {0.1}}});
  const auto candidates = attachments(b.bound, all_effects(), distinct_inputs(b.bound, b.base, {0, 1}, b.runs));
  const auto proposals = propose(b.bound, b.base, b.problem, candidates, 0, serially());
  REQUIRE(proposals.size() > 20);
  const auto found = std::find_if(proposals.begin(), proposals.end(), [](const Proposal& proposal) {
    return proposal.effect.label() == "constant_force at omega";
  });
  REQUIRE(found != proposals.end());
  CHECK(found - proposals.begin() < 6);
  CHECK(found->start[0] == doctest::Approx(0.1).epsilon(0.15));
  CHECK(found->gain > 0.9);
  for (std::size_t i = 1; i < proposals.size(); ++i) CHECK(proposals[i].gain <= proposals[i - 1].gain);
  for (const Proposal& proposal : proposals) {
    CHECK(proposal.gain <= 1);
    CHECK(proposal.distinct <= 1 + 1e-9);
  }
}

TEST_CASE("a late actuator inside a control loop is proposed where it is") {
  const Bench b = bench({{"input_delay", "duty", {}, {}, {0.06}}});
  const auto candidates = attachments(b.bound, all_effects(), distinct_inputs(b.bound, b.base, {0, 1}, b.runs));
  const auto proposals = propose(b.bound, b.base, b.problem, candidates, 0, serially());
  CHECK(proposals.front().effect.label() == "input_delay at duty");
}

TEST_CASE("a reading that was rounded before it drifted is rounded in front of the drift") {
  constexpr double step = 0.05;
  const NamedEffect drift{"sensor_drift", "theta_rad", {}, {}, {0.3}};
  Bench b = bench({{"quantization", "theta_rad", {}, {}, {step}}, drift});
  b.base.effects.push_back(attach(b.bound.info, drift, all_effects()));
  b.base.values.emplace_back(Eigen::VectorXd::Constant(1, drift.values[0]));
  auto candidates = attachments(b.bound, all_effects(), {true, true, true});
  std::erase_if(candidates, [](const AttachedEffect& one) {
    return !one.effect->form.empty() || one.effect->name != "quantization";
  });
  const auto proposals = propose(b.bound, b.base, b.problem, candidates, 0, serially());
  REQUIRE_FALSE(proposals.empty());
  CHECK(proposals[0].before == 0);
  CHECK(proposals[0].start[0] == doctest::Approx(step).epsilon(0.01));
  CHECK(proposals[0].gain > 0.9);
  // where the drift is the model's own, steps behind it explain little
  for (const Proposal& behind : propose(b.bound, b.base, b.problem, candidates, 1, serially())) {
    CHECK(behind.gain < 0.5 * proposals[0].gain);
  }

  const Hypothesis both = with_effect(b.base, proposals[0].effect, proposals[0].start, proposals[0].before);
  CHECK(both.effects[0].effect->name == "quantization");
  CHECK(both.effects[1].effect->name == "sensor_drift");
  CHECK(both.values[1][0] == drift.values[0]);
}

TEST_CASE("what parameters can do is no effect, though they do nothing inside of the steps of a sensor") {
  constexpr double step = 0.02;
  const NamedEffect steps{"quantization", "theta_rad", {}, {}, {step}};
  Bench b = bench({steps});
  for (double& parameter : b.base.parameters) parameter *= 1.01;
  b.problem.weighting.sigma.setConstant(1, 0.3 * step);
  b.base.effects.push_back(attach(b.bound.info, steps, all_effects()));
  b.base.values.push_back(Vec<1>(step));
  const auto candidates = attachments(b.bound, all_effects(), distinct_inputs(b.bound, b.base, {0, 1}, b.runs));
  CHECK(propose(b.bound, b.base, b.problem, candidates, 0, serially()).front().gain < 0.1);
}

TEST_CASE("beside another effect, one without a strength counts as it was tried") {
  const Bench b = bench({{"rate_limit", "duty", {}, {}, {2}}});
  auto candidates = attachments(b.bound, all_effects(), distinct_inputs(b.bound, b.base, {0, 1}, b.runs));
  std::erase_if(candidates, [](const AttachedEffect& one) { return one.label() != "rate_limit at duty"; });
  const auto proposals = propose(b.bound, b.base, b.problem, candidates, 0, serially());
  REQUIRE(proposals.size() == 2);  // and from rest
  for (const Proposal& one : proposals) {
    CHECK(one.least_share[0] == 1);
    CHECK(one.most_share[0] == 1);
  }
}

TEST_CASE("where nothing is missing no proposal explains much") {
  const Bench b = bench({});
  const auto candidates = attachments(b.bound, all_effects(), distinct_inputs(b.bound, b.base, {0, 1}, b.runs));
  for (const Proposal& proposal : propose(b.bound, b.base, b.problem, candidates, 0, serially())) {
    INFO(proposal.effect.label());
    CHECK(proposal.gain < 0.1);
  }
}

TEST_CASE("the signature of an effect grows with its strength, and one that does nothing explains nothing") {
  const Bench b = bench({});
  const OpenResiduals open = open_residuals(b.bound, b.base, b.problem, serially());
  const AttachedEffect force = attachments(b.bound, {effects::constant_force()}, {true, true, true}).front();
  const Eigen::MatrixXd one = signatures(b.bound, b.base, b.problem, open.residuals, force, Vec<1>(0.01), 0);
  const Eigen::MatrixXd two = signatures(b.bound, b.base, b.problem, open.residuals, force, Vec<1>(0.02), 0);
  REQUIRE(one.cols() == 1);
  CHECK(two.norm() == doctest::Approx(2 * one.norm()).epsilon(0.05));
  const Proposal nothing = predict_gain(b.bound, open, force, Vec<1>(0.01), 0 * one, {});
  CHECK(nothing.gain == 0);
  CHECK(nothing.visible == 0);
  CHECK_FALSE(predict_gain(b.bound, open, force, Vec<1>(0.01), {}, {}).effect.effect);  // it ran away
}

TEST_CASE(
    "what a signature says beside others is handed on: beyond the parameters, against the residuals, its limits") {
  const Bench b = bench({{"constant_force", "omega", {}, {}, {0.1}}});
  const OpenResiduals open = open_residuals(b.bound, b.base, b.problem, serially());
  const AttachedEffect force = attachments(b.bound, {effects::constant_force()}, {true, true, true}).front();
  const Eigen::MatrixXd signature = signatures(b.bound, b.base, b.problem, open.residuals, force, Vec<1>(0.01), 0);
  const Proposal one = predict_gain(b.bound, open, force, Vec<1>(0.01), signature, {});
  REQUIRE(one.beyond.cols() == 1);
  CHECK((one.beyond * std::sqrt(open.energy) - open.beyond_parameters(signature)).norm() < 1e-9 * signature.norm());
  CHECK(one.along[0] == doctest::Approx((one.beyond.transpose() * open.open)(0, 0) / std::sqrt(open.energy)));
  CHECK(one.gain == doctest::Approx(one.along.squaredNorm() / one.beyond.squaredNorm()));
  CHECK(one.start[0] == doctest::Approx(-0.01 * one.along[0] / one.beyond.squaredNorm()));
  const EffectParameter& strength = force.effect->parameters.front();
  const double size = measure_size(b.bound, force, strength.measure);
  CHECK(one.least_share[0] == doctest::Approx(strength.low * size / 0.01));
  CHECK(one.most_share[0] == doctest::Approx(strength.high * size / 0.01));
}

TEST_CASE("strengths are the parameters in proportion to which an effect vanishes") {
  Effect effect;
  effect.parameters = {{.name = "delay", .starts = {}},
                       {.name = "force", .starts = {}, .strength = true},
                       {.name = "other force", .starts = {}, .strength = true}};
  CHECK(strengths_of(effect) == std::vector<Eigen::Index>{1, 2});
  CHECK(strengths_of({}).empty());
}

TEST_CASE("a strength that causes more than what is left is made as small as that") {
  const Bench b = bench({});
  auto candidates = attachments(b.bound, all_effects(), {true, true, true});
  const auto attached = [&](const char* label) {
    return *std::find_if(candidates.begin(), candidates.end(),
                         [&](const AttachedEffect& one) { return one.label() == label; });
  };
  OpenResiduals open;
  open.residuals = Eigen::VectorXd::Constant(4, 1);
  const Eigen::VectorXd two = Eigen::VectorXd::Constant(1, 2);
  const AttachedEffect force = attached("constant_force at omega");
  CHECK(as_large_as_residuals(force, two, Eigen::MatrixXd::Constant(4, 1, 10), open)[0] == doctest::Approx(0.2));
  CHECK(as_large_as_residuals(force, two, Eigen::MatrixXd::Constant(4, 1, 1.9), open)[0] == 2);  // near enough
  CHECK(as_large_as_residuals(force, two, Eigen::MatrixXd::Constant(4, 1, 0.1), open)[0] == 2);  // no larger
  const AttachedEffect limited = attached("rate_limit at duty");  // which has no strength
  CHECK(as_large_as_residuals(limited, two, Eigen::MatrixXd::Constant(4, 1, 10), open)[0] == 2);
}

TEST_CASE("what is left is small, and so are the effects it is screened with") {
  const Bench b = bench({{"constant_force", "omega", {}, {}, {0.004}}});
  const auto candidates = attachments(b.bound, all_effects(), distinct_inputs(b.bound, b.base, {0, 1}, b.runs));
  const OpenResiduals open = open_residuals(b.bound, b.base, b.problem, serially());
  int screened = 0;
  for (const Proposal& one : propose(b.bound, b.base, b.problem, candidates, 0, serially())) {
    if (strengths_of(*one.effect.effect).empty() || one.effect.effect->is_impulsive) continue;
    const Eigen::MatrixXd changes =
        signatures(b.bound, b.base, b.problem, open.residuals, one.effect, one.tried, one.before);
    INFO(one.effect.label());
    CHECK(changes.colwise().norm().maxCoeff() < 4 * open.residuals.norm());
    ++screened;
  }
  CHECK(screened > 10);
}

}  // namespace
}  // namespace surefoot::diagnosis

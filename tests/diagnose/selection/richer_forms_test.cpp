// Forms that others are special cases of; effects with a memory where recordings begin in the middle of what they do.
#include "surefoot/diagnose/selection/richer_forms.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/diagnose/selection/extend.hpp"
#include "surefoot/diagnose/selection/rivals.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot {
namespace {

/// A block on a damped spring; both are known.
struct SprungBlock : toys::SlidingBlock {
  SimulatorInfo info() const {
    SimulatorInfo info = SlidingBlock::info();
    info.parameters[1].value = 2;
    info.parameters[2].value = 20;
    return info;
  }
};

/// Six logs of 4 s, with noise of 1 mm and 1 mm/s, of which the first `cut` rows were not kept; simulated with steps of
/// so many seconds, or of a row.
std::vector<Recording> block_logs(const NamedEffect& effect, Eigen::Index cut, double step = 0) {
  std::vector<Recording> logs;
  Rng rng(11);
  for (std::size_t r = 0; r < 6; ++r) {
    Recording whole = toys::blank_recording(SprungBlock{}.info(), 200 + cut, 0.02);
    for (Eigen::Index i = 0; i < whole.rows(); ++i) {
      const double t = whole.time[i] - 0.3 * static_cast<double>(r);
      whole.inputs(0, i) = (std::fmod(t + 9, 2.2) < 1 ? 9 : -7) + 2 * std::sin(2.1 * t);
    }
    const SimulatedRun run =
        simulate_augmented(SprungBlock{}, toys::machine({2, 2, 20}, {effect}, {.step = step}), whole);
    whole.outputs = run.outputs;
    Recording log = part_of(whole, cut, whole.rows(), run.states.col(cut), Eigen::VectorXd::Zero(2));
    for (Eigen::Index i = 0; i < log.rows(); ++i) log.time[i] = 0.02 * static_cast<double>(i);
    for (double& reading : log.outputs.reshaped()) reading += 0.001 * rng.normal();
    log.name = "block " + std::to_string(r);
    logs.push_back(std::move(log));
  }
  return logs;
}

Diagnosis diagnosed(const NamedEffect& effect, Eigen::Index cut, double step = 0) {
  return diagnose(SprungBlock{}, block_logs(effect, cut, step), DiagnoseOptions{}, Threads{}, 1);
}

TEST_CASE("what an actuator was at when a recording begins is found, and its name with it") {
  for (const NamedEffect& effect :
       {NamedEffect{"first_order_lag", "push", {}, {}, {0.6}}, NamedEffect{"rate_limit", "push", {}, {}, {9}}}) {
    const Diagnosis found = diagnosed(effect, 60);
    INFO(found.sentence);
    CHECK(found.verdict == Verdict::missing_physics);
    REQUIRE(found.effects.size() == 1);
    CHECK(found.effects[0].name == effect.name);
    CHECK(found.effects[0].form == "not settled");
    CHECK(found.effects[0].parameters[0].value == doctest::Approx(effect.values[0]).epsilon(0.03));
    CHECK(found.noise_ratio < 1.1);
  }
}

TEST_CASE("a memory that recordings find settled is called by its plain name") {
  const Diagnosis found = diagnosed({"hysteresis", "v", {}, {}, {4, 0.2}}, 0);
  REQUIRE(found.effects.size() == 1);
  CHECK(found.effects[0].name == "hysteresis");
  CHECK(found.effects[0].form.find("not settled") == std::string::npos);
}

TEST_CASE("a force that was there before the first row is found with its hysteresis") {
  const Diagnosis found = diagnosed({"hysteresis", "v", {}, {}, {4, 0.2}}, 60);
  INFO(found.sentence);
  REQUIRE(found.effects.size() == 1);
  CHECK(found.effects[0].name == "hysteresis");
  CHECK(found.effects[0].form == "not settled");
  CHECK(found.noise_ratio < 1.1);
}

TEST_CASE("a friction of damped bristles is found with the time of its damping") {
  const Diagnosis found = diagnosed({"coulomb_friction", "v", "presliding, damped", {}, {4, 0.03, 0.06}}, 0);
  INFO(found.sentence);
  REQUIRE(found.effects.size() == 1);
  CHECK(found.effects[0].name == "coulomb_friction");
  CHECK(found.effects[0].form == "presliding, damped");
  CHECK(found.effects[0].parameters[2].value == doctest::Approx(0.06).epsilon(0.1));
  CHECK(found.noise_ratio < 1.1);
}

/// A search among the forms of one effect.
struct FormSearch {
  diagnosis::BoundSimulator bound;
  std::vector<AttachedEffect> candidates;
  diagnosis::SearchProblem problem;
  diagnosis::Parallel alone = diagnosis::serially();

  diagnosis::Search search() const { return {bound, problem, candidates, alone}; }

  diagnosis::EvaluatedHypothesis fitted(const std::string& form, const Eigen::VectorXd& values) const {
    using namespace diagnosis;
    Hypothesis start = nominal_hypothesis(bound);
    start.effects.push_back(*std::find_if(candidates.begin(), candidates.end(),
                                          [&](const AttachedEffect& one) { return one.effect->form == form; }));
    start.values.push_back(values);
    return evaluate_fit(bound, fit(bound, start, problem.fit, alone), problem, alone);
  }
};

/// Logs of a block with this effect, and effects of these names to be tried; of its own if none are given.
FormSearch search_of(const NamedEffect& effect, std::vector<std::string> names = {}) {
  using namespace diagnosis;
  FormSearch result{.bound = bind_simulator(SprungBlock{}, block_logs(effect, 0)), .candidates = {}, .problem = {}};
  std::vector<Effect> forms = all_effects();
  if (names.empty()) names = {effect.name};
  std::erase_if(forms, [&](const Effect& one) { return std::ranges::find(names, one.name) == names.end(); });
  result.candidates = attachments(result.bound, forms, std::vector<bool>(1, true));
  for (std::size_t r = 0; r < result.bound.recordings.size(); ++r) result.problem.fit.recordings.push_back(r);
  result.problem.screened = result.problem.fit.recordings;
  const Hypothesis nominal = nominal_hypothesis(result.bound);
  const auto runs = simulate_all(result.bound, nominal, result.problem.fit.recordings, {}, serially());
  result.bound.sizes = measure_sizes(result.bound, nominal, result.problem.fit.recordings, runs);
  result.problem.fit.weighting.sigma.setConstant(2, 0.001);
  result.problem.scale.sigma = error_scale(result.bound);
  result.problem.candidates = result.candidates.size();
  return result;
}

TEST_CASE("damped bristles are found beside plain friction, though undamped ones would leave more") {
  using namespace diagnosis;
  const FormSearch forms =
      search_of({"load_dependent_friction", "v", "drive, presliding, damped", {}, {0.4, 0.03, 0.06}});
  const EvaluatedHypothesis plain = forms.fitted("drive", Eigen::VectorXd::Constant(1, 0.4));
  const auto richer = in_richer_forms(forms.search(), plain, ErrorsOfForm::counted);
  REQUIRE(richer.has_value());
  CHECK(richer->hypothesis.effects[0].effect->form == "drive, presliding, damped");
  CHECK(richer->errors.rms() < 0.1 * plain.errors.rms());
}

TEST_CASE("a richer form that does not come as near as it must in a few iterations is not fitted to the end") {
  using namespace diagnosis;
  const FormSearch forms =
      search_of({"load_dependent_friction", "v", "drive, presliding, damped", {}, {0.4, 0.03, 0.06}});
  const EvaluatedHypothesis plain = forms.fitted("drive", Eigen::VectorXd::Constant(1, 0.4));
  CHECK(in_richer_forms(forms.search(), plain, ErrorsOfForm::counted, plain.loss).has_value());
  constexpr double out_of_reach = 1e-60;
  CHECK_FALSE(in_richer_forms(forms.search(), plain, ErrorsOfForm::counted, out_of_reach).has_value());
}

TEST_CASE("a richer form that takes away nothing in a few iterations is not fitted to the end") {
  using namespace diagnosis;
  FormSearch forms = search_of({"coulomb_friction", "v", "", {}, {4}});
  const EvaluatedHypothesis plain = forms.fitted("", Eigen::VectorXd::Constant(1, 4));
  forms.problem.effort.first_iterations = 1;
  int jacobians = 0;
  forms.problem.fit.stopped = [&jacobians] { return ++jacobians > 100; };
  CHECK_FALSE(in_richer_forms(forms.search(), plain, ErrorsOfForm::counted).has_value());
  CHECK(jacobians <= 4);  // of either form one step, and the question after it
}

TEST_CASE("forms that differ by less than an error of form are compared in full, but not while effects are sought") {
  using namespace diagnosis;
  FormSearch forms = search_of({"cubic_stiffness", "v", "off center", {}, {40, 0.0005}});
  forms.problem.least = Eigen::VectorXd::Constant(2, 1e3);  // mean squares, in the unit of errors: all of them
  const EvaluatedHypothesis plain = forms.fitted("", Eigen::VectorXd::Constant(1, 40));
  CHECK_FALSE(in_richer_forms(forms.search(), plain, ErrorsOfForm::tolerated).has_value());
  const auto richer = in_richer_forms(forms.search(), plain, ErrorsOfForm::counted);
  REQUIRE(richer.has_value());
  CHECK(richer->hypothesis.effects[0].effect->form == "off center");
  CHECK(richer->hypothesis.values[0][1] == doctest::Approx(0.0005).epsilon(0.2));
  CHECK(log_odds(*richer, plain, forms.problem.criteria) < std::log(forms.problem.criteria.named_odds));
}

TEST_CASE("what a form adds is found though everything else was fitted to make up for it") {
  using namespace diagnosis;
  for (const Eigen::Vector2d& frequencies :
       {Eigen::Vector2d(8, 17.6), Eigen::Vector2d(15, 9), Eigen::Vector2d(12, 18)}) {
    CAPTURE(frequencies.transpose());
    FormSearch forms =
        search_of({"joint_elasticity", "v", "two modes", {}, {0.2, frequencies[0], 0.06, 0.2, frequencies[1]}});
    const EvaluatedHypothesis plain = forms.fitted("", Eigen::Vector3d(0.26, frequencies[0], 0.05));
    // a mode of its own bends to anything: it is not believed where it leaves more than noise
    CHECK_FALSE(in_richer_forms(forms.search(), plain, ErrorsOfForm::counted).has_value());
    forms.problem.structured = [](const Hypothesis& one, const FitProblem&) {
      return one.effects[0].effect->form.empty();
    };
    const auto richer = in_richer_forms(forms.search(), plain, ErrorsOfForm::counted);
    REQUIRE(richer.has_value());
    const Eigen::VectorXd& values = richer->hypothesis.values[0];
    CHECK(std::min(values[1], values[4]) == doctest::Approx(frequencies.minCoeff()).epsilon(0.02));
    CHECK(std::max(values[1], values[4]) == doctest::Approx(frequencies.maxCoeff()).epsilon(0.02));
    CHECK(richer->errors.rms() < 0.1 * plain.errors.rms());
  }
}

TEST_CASE("other forms of an effect are tried from the fit that was found, the best first") {
  using namespace diagnosis;
  FormSearch forms = search_of({"coulomb_friction", "v", "smooth", {}, {4, 0.08}});
  const EvaluatedHypothesis found = forms.fitted("", Eigen::VectorXd::Constant(1, 3.8));
  const auto others = in_other_forms(forms.search(), found, 0, 3, false);
  REQUIRE_FALSE(others.empty());
  CHECK(others[0].hypothesis.effects[0].effect->form == "smooth");
  CHECK(others[0].hypothesis.values[0][1] == doctest::Approx(0.08).epsilon(0.05));
  CHECK(others[0].errors.rms() < 0.5 * found.errors.rms());
  for (const EvaluatedHypothesis& other : others) {
    CHECK(other.hypothesis.effects.size() == 1);
    CHECK_FALSE(other.hypothesis.effects[0].effect->form.empty());  // not itself
    CHECK(other.hypothesis.effects[0].effect->extends.empty());
  }

  int asked = 0;
  forms.problem.stopped = [&asked] { return ++asked > 2; };  // some fits have not begun
  CHECK(in_other_forms(forms.search(), found, 0, 3, false).size() <= 3);
}

TEST_CASE("a form that only readings suggest is tried where another one was found") {
  using namespace diagnosis;
  const FormSearch forms = search_of({"quantization", "x_m", "floor", {}, {0.03}});
  const EvaluatedHypothesis found = forms.fitted("", Eigen::VectorXd::Constant(1, 0.03));
  const auto others = in_other_forms(forms.search(), found, 0, 3, false);
  REQUIRE(others.size() == 1);
  CHECK(others[0].hypothesis.effects[0].effect->form == "floor");
  CHECK(others[0].hypothesis.values[0][0] == doctest::Approx(0.03).epsilon(0.01));
  CHECK(others[0].errors.rms() < 0.5 * found.errors.rms());
}

TEST_CASE("backlash whose gap has closed is tried as the elastic joint that it comes to, from where it was found") {
  using namespace diagnosis;
  FormSearch forms = search_of({"joint_elasticity", "v", "", {}, {0.3, 15, 0.05}}, {"joint_elasticity", "backlash"});
  const EvaluatedHypothesis found = forms.fitted("gap", Eigen::Vector4d(0.3, 0.001, 15, 0.05));
  std::vector<EvaluatedHypothesis> pool{found};
  exchange_effects(forms.search(), pool);
  const EvaluatedHypothesis& best = pool[best_of(pool, forms.problem.criteria)];
  CHECK(best.hypothesis.effects[0].effect->name == "joint_elasticity");
  CHECK(best.hypothesis.values[0][1] == doctest::Approx(15).epsilon(0.02));

  const AttachedEffect &joint = best.hypothesis.effects[0], &gap = found.hypothesis.effects[0];
  const Eigen::Vector4d values(0.3, 0.001, 15, 0.05);
  CHECK(values_of_special_case(joint, gap, values) == Eigen::Vector3d(0.3, 15, 0.05));
  CHECK(values_of_special_case(gap, joint, values.head(3)).size() == 0);  // which has no gap
  AttachedEffect elsewhere = joint;
  elsewhere.at = 0;
  CHECK(values_of_special_case(elsewhere, gap, values).size() == 0);
}

TEST_CASE("friction that grows within a hundredth of the speed is found, though rows are too long to simulate it") {
  constexpr double onset = 0.003, step = 0.0005;
  const Diagnosis found = diagnosed({"coulomb_friction", "v", "smooth", {}, {4, onset}}, 0, step);
  INFO(found.sentence);
  REQUIRE(found.effects.size() == 1);
  CHECK(found.effects[0].name == "coulomb_friction");
  CHECK(found.effects[0].form == "smooth");
  CHECK(found.effects[0].parameters[1].value / onset == doctest::Approx(1).epsilon(0.2));
  CHECK(found.noise_ratio < 1.1);
}

TEST_CASE("the edges of a coarse sensor are as sharp as its readings say") {
  for (const std::string form : {"sharp", ""}) {
    const Diagnosis found = diagnosed({"quantization", "x_m", form, {}, {0.03}}, 0);
    INFO(found.sentence);
    REQUIRE(found.effects.size() == 1);
    CHECK(found.effects[0].name == "quantization");
    CHECK(found.effects[0].form == form);
    CHECK(found.effects[0].parameters[0].value == doctest::Approx(0.03).epsilon(0.01));
    CHECK(found.noise_ratio < 1.1);
  }
}

TEST_CASE("a tank that overflows as over a weir is told from one that is cut off") {
  for (const NamedEffect& effect :
       {NamedEffect{"overflow", "level", "weir", {}, {0.2, 10}}, NamedEffect{"overflow", "level", "", {}, {0.3}}}) {
    std::vector<Recording> logs;
    Rng rng(5);
    for (int r = 0; r < 6; ++r) {
      Recording log = toys::tank_recording(r, 200);
      log.outputs = simulate_augmented(toys::LeakyTank{}, toys::machine({1.1, 0.9}, {effect}), log).outputs;
      for (double& level : log.outputs.reshaped()) level += 0.002 * rng.normal();
      logs.push_back(std::move(log));
    }
    const Diagnosis found = diagnose(toys::LeakyTank{}, std::move(logs), DiagnoseOptions{}, Threads{}, 1);
    INFO(found.sentence);
    REQUIRE(found.effects.size() == 1);
    CHECK(found.effects[0].name == "overflow");
    CHECK(found.effects[0].form == effect.form);
    CHECK(found.effects[0].parameters[0].value == doctest::Approx(effect.values[0]).epsilon(0.05));
    CHECK(found.noise_ratio < 1.1);
  }
}

TEST_CASE("a hysteresis between two forms is found in the one that holds both, a plain one in its own") {
  const Diagnosis between = diagnosed({"hysteresis", "v", "any exponent", {}, {4, 0.2, 0, 1.5}}, 0);
  INFO(between.sentence);
  REQUIRE(between.effects.size() == 1);
  CHECK(between.effects[0].form == "any exponent");
  CHECK(between.effects[0].parameters[3].value == doctest::Approx(1.5).epsilon(0.1));
  CHECK(between.noise_ratio < 1.1);
  const Diagnosis plain = diagnosed({"hysteresis", "v", "n = 2", {}, {4, 0.2}}, 0);
  REQUIRE(plain.effects.size() == 1);
  CHECK(plain.effects[0].form == "n = 2");
}

TEST_CASE("a lag of second order is no lag and a delay, and a drift that is bent no drifts of several parameters") {
  for (const NamedEffect& effect : {NamedEffect{"first_order_lag", "push", "second order", {}, {0.3, 0.25}},
                                    NamedEffect{"parameter_drift", "mass", "bent", {}, {0.01, 0.03}},
                                    NamedEffect{"parameter_drift", "mass", "midway", {}, {0.6, 2, 0.3}}}) {
    const Diagnosis found = diagnosed(effect, 0);
    INFO(found.sentence);
    CHECK(found.verdict == Verdict::missing_physics);
    REQUIRE(found.effects.size() == 1);
    CHECK(found.effects[0].name == effect.name);
    CHECK(found.effects[0].form == effect.form);
    CHECK(found.effects[0].parameters[1].value == doctest::Approx(effect.values[1]).epsilon(0.1));
    CHECK(found.noise_ratio < 1.1);
  }
}

TEST_CASE("what only mends the form of another effect gives way to a richer form of that one") {
  using namespace diagnosis;
  const FormSearch forms =
      search_of({"first_order_lag", "push", "second order", {}, {0.3, 0.25}}, {"first_order_lag", "input_delay"});
  Hypothesis two = nominal_hypothesis(forms.bound);
  for (const std::string name : {"first_order_lag", "input_delay"}) {
    two.effects.push_back(
        *std::ranges::find_if(forms.candidates, [&](const AttachedEffect& one) { return one.effect->name == name; }));
    two.values.push_back(Eigen::VectorXd::Constant(1, 0.15));
  }
  const EvaluatedHypothesis both = refitted(forms.search(), two);
  std::vector<EvaluatedHypothesis> pool{both};
  Search search = forms.search();
  try_confusable(search, pool);
  const EvaluatedHypothesis& best = pool[best_of(pool, forms.problem.criteria)];
  REQUIRE(best.hypothesis.effects.size() == 1);
  CHECK(best.hypothesis.effects[0].effect->form == "second order");
  CHECK(log_odds(best, both, forms.problem.criteria) > 10);
}

}  // namespace
}  // namespace surefoot

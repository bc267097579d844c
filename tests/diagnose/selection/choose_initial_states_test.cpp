// Initial states that a model takes for known, and recordings refute.
#include "surefoot/diagnose/selection/choose_initial_states.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

/// A block on a spring of which only the position is read.
struct SeenBlock : toys::SlidingBlock {
  using Output = Vec<1>;
  SimulatorInfo info() const {
    SimulatorInfo info = SlidingBlock::info();
    info.outputs.pop_back();
    for (ParameterInfo& parameter : info.parameters) parameter.fixed = parameter.name == "damping";
    info.parameters[1].value = 1;
    info.parameters[2].value = 10;
    return info;
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};

/// Six recordings of 4 s with noise of 2 mm that begin at these speeds, of which the model says 0; with these effects.
std::vector<Recording> block_logs(const std::vector<double>& speeds, const std::vector<NamedEffect>& effects = {}) {
  std::vector<Recording> recordings;
  Rng rng(5);
  for (std::size_t r = 0; r < speeds.size(); ++r) {
    Recording recording = toys::blank_recording(SeenBlock{}.info(), 200, 0.02);
    recording.name = "block " + std::to_string(r);
    for (Eigen::Index i = 0; i < recording.rows(); ++i) {
      const double t = recording.time[i];
      recording.inputs(0, i) = 6 * std::sin((1.5 + 0.3 * static_cast<double>(r)) * t) + (std::fmod(t, 2) < 1 ? 3 : -2);
    }
    recording.initial[1] = speeds[r];
    recording.outputs = simulate_augmented(SeenBlock{}, toys::machine({2, 1, 10}, effects), recording).outputs;
    for (double& position : recording.outputs.reshaped()) position += 0.002 * rng.normal();
    recording.initial[1] = 0;
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

const std::vector<double> in_motion{0.5, -0.4, 0.8, 0, -0.7, 0.3}, at_rest(6, 0.0);

struct BlockBench {
  BoundSimulator bound;
  SearchProblem problem;
  Fit fitted;
};
BlockBench block_bench(const std::vector<double>& speeds) {
  BlockBench b{bind_simulator(SeenBlock{}, block_logs(speeds)), {}, {}};
  b.problem.fit.recordings = {0, 1, 2, 3, 4, 5};
  b.problem.scale.sigma.setConstant(1, 0.1);
  b.fitted = calibrate(b.bound, nominal_hypothesis(b.bound), b.problem.fit, 4, 1, serially());
  const auto runs = simulate_all(b.bound, b.fitted.hypothesis, b.problem.fit.recordings, {}, serially());
  b.bound.sizes = measure_sizes(b.bound, b.fitted.hypothesis, b.problem.fit.recordings, runs);
  return b;
}

TEST_CASE("a speed that recordings do not begin with is freed; a position that is read, never") {
  BlockBench b = block_bench(in_motion);
  CHECK(free_initial_states(b.bound, b.fitted, b.problem, serially()) == std::vector<bool>{false, true});
  for (std::size_t r = 0; r < in_motion.size(); ++r) {
    CHECK(b.bound.recordings[r].initial_scale[1] > 0);
    CHECK(b.fitted.hypothesis.initial[r][1] == doctest::Approx(in_motion[r]).epsilon(0.05));
  }
  CHECK(free_initial_states(b.bound, b.fitted, b.problem, serially()) == std::vector<bool>{false, false});  // once
}

TEST_CASE("all states that may be free are tried at once, and recordings stay as they are") {
  const BlockBench moving = block_bench(in_motion), resting = block_bench(at_rest);
  const double named = std::log(moving.problem.criteria.named_odds);
  const FreedTogether needed = free_together(moving.bound, moving.fitted, moving.problem, 4, 1, serially());
  CHECK(needed.states == std::vector<bool>{false, true});
  CHECK(needed.log_odds > named);
  CHECK(needed.fitted.hypothesis.initial[0][1] == doctest::Approx(in_motion[0]).epsilon(0.05));
  CHECK(moving.bound.recordings[0].initial_scale[1] == 0);
  CHECK(free_together(resting.bound, resting.fitted, resting.problem, 4, 1, serially()).log_odds < named);

  BlockBench free = block_bench(in_motion);
  free_initial_states(free.bound, free.fitted, free.problem, serially());
  CHECK_FALSE(free_together(free.bound, free.fitted, free.problem, 4, 1, serially()).fitted.ok);  // none is left
}

TEST_CASE("what begins as the model says is left alone, and known again if it was freed in vain") {
  BlockBench b = block_bench(at_rest);
  CHECK(free_initial_states(b.bound, b.fitted, b.problem, serially()) == std::vector<bool>{false, false});
  CHECK(b.bound.recordings[0].initial_scale[1] == 0);

  std::vector<bool> freed{false, true};
  set_initial_scale(b.bound, 1, 1.0);
  restore_initial_states(b.bound, freed, b.fitted, b.problem, serially());
  CHECK_FALSE(freed[1]);
  CHECK(b.bound.recordings[0].initial_scale[1] == 0);
  CHECK(b.fitted.hypothesis.initial[0][1] == 0);

  BlockBench moving = block_bench(in_motion);
  std::vector<bool> needed = free_initial_states(moving.bound, moving.fitted, moving.problem, serially());
  const double scale = moving.bound.recordings[0].initial_scale[1];
  restore_initial_states(moving.bound, needed, moving.fitted, moving.problem, serially());
  CHECK(needed[1]);
  CHECK(moving.bound.recordings[0].initial_scale[1] == scale);
}

TEST_CASE("a diagnosis of recordings that begin in motion names what is missing, and says where they begin") {
  const auto has_remark = [](const Diagnosis& found) {
    return std::ranges::any_of(found.remarks, [](const Remark& one) {
      return one.text.find("recordings do not begin with v as the model says") != std::string::npos;
    });
  };
  const Diagnosis none = diagnose(SeenBlock{}, block_logs(in_motion), DiagnoseOptions{}, Threads{}, 1);
  CHECK(none.effects.empty());
  CHECK(none.verdict != Verdict::unexplained);
  CHECK(has_remark(none));
  CHECK(none.freed_states == std::vector<bool>{false, true});

  const NamedEffect friction{"coulomb_friction", "v", {}, {}, {0.8}};
  const Diagnosis rubs = diagnose(SeenBlock{}, block_logs(in_motion, {friction}), DiagnoseOptions{}, Threads{}, 1);
  REQUIRE(rubs.effects.size() == 1);
  CHECK(rubs.effects[0].name == "coulomb_friction");
  CHECK(rubs.effects[0].parameters[0].value == doctest::Approx(0.8).epsilon(0.03));
  CHECK(has_remark(rubs));

  const Diagnosis rests = diagnose(SeenBlock{}, block_logs(at_rest, {friction}), DiagnoseOptions{}, Threads{}, 1);
  REQUIRE(rests.effects.size() == 1);
  CHECK_FALSE(has_remark(rests));
}

TEST_CASE("initial states are not freed for what the search has yet to find: its stop and bounces are told") {
  const NamedEffect stop{"end_stop", "v", "upper", {}, {0.2, 0.5}};
  const Diagnosis found = diagnose(SeenBlock{}, block_logs(at_rest, {stop}), DiagnoseOptions{}, Threads{}, 1);
  CHECK(found.verdict == Verdict::missing_physics);
  REQUIRE(found.effects.size() == 1);
  CHECK(found.effects[0].name == "end_stop");
}

}  // namespace
}  // namespace surefoot::diagnosis

// Where the fit of an effect starts.
#include "surefoot/diagnose/estimation/starting_values.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/diagnose/effects/dead_zone.hpp"
#include "surefoot/diagnose/effects/first_order_lag.hpp"
#include "surefoot/diagnose/effects/overflow.hpp"
#include "surefoot/diagnose/effects/quantization.hpp"
#include "surefoot/diagnose/effects/stribeck_friction.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

AttachedEffect attached(const BoundSimulator& bound, const Effect& effect) {
  return attachments(bound, {effect}, std::vector<bool>(bound.info.inputs.size(), true)).front();
}

BoundSimulator tank(double interval) {
  Recording recording = toys::blank_recording(toys::LeakyTank{}.info(), 400, interval);
  for (Eigen::Index i = 0; i < 400; ++i) recording.outputs(0, i) = std::min(2.0, 0.01 * static_cast<double>(i));
  BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {recording});
  const Hypothesis nominal = nominal_hypothesis(bound);
  bound.sizes = measure_sizes(bound, nominal, {0}, simulate_all(bound, nominal, {0}, {}, serially()));
  return bound;
}

std::vector<Observed> observed(const BoundSimulator& bound) {
  return observe(bound, {0}, simulate_all(bound, nominal_hypothesis(bound), {0}, {}, serially()));
}

TEST_CASE("a level that readings never pass is where an overflow starts") {
  const BoundSimulator bound = tank(0.05);
  const auto starts = starting_values(bound, attached(bound, effects::overflow()), observed(bound));
  REQUIRE_FALSE(starts.empty());
  for (const Eigen::VectorXd& start : starts) CHECK(start[0] == doctest::Approx(2.0));
}

// The same tank, read in cm below its brim.
struct TankFromAbove : toys::LeakyTank {
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const {
    return Output(300 - 100 * x[0]);
  }
};

TEST_CASE("readings in another unit say in that of the state where an overflow starts") {
  BoundSimulator bound = tank(0.05);
  Recording recording = bound.recordings[0];
  for (double& level : recording.outputs.reshaped()) level = 300 - 100 * level;
  bound = bind_simulator(TankFromAbove{}, {recording});
  bound.sizes = measure_sizes(bound, nominal_hypothesis(bound), {0},
                              simulate_all(bound, nominal_hypothesis(bound), {0}, {}, serially()));
  const auto starts = starting_values(bound, attached(bound, effects::overflow()), observed(bound));
  REQUIRE_FALSE(starts.empty());
  for (const Eigen::VectorXd& start : starts) CHECK(start[0] == doctest::Approx(2.0));
}

TEST_CASE("what starts at a share of the largest value does so where the velocity's position went") {
  Recording recording = toys::blank_recording(toys::SlidingBlock{}.info(), 100, 0.1);
  recording.inputs.setConstant(0.5);
  BoundSimulator bound = bind_simulator(toys::SlidingBlock{}, {recording});
  const Hypothesis nominal = nominal_hypothesis(bound);
  const auto runs = simulate_all(bound, nominal, {0}, {}, serially());
  bound.sizes = measure_sizes(bound, nominal, {0}, runs);
  const Effect wall{.name = "wall",
                    .place = Place::velocity,
                    .parameters = {{.name = "where", .measure = {.position = 1}, .starts = {0.8}, .of_peak = true}},
                    .force = [](const EffectContext& m, Values p, Values) { return m.position > p[0] ? -1.0 : 0.0; }};
  const auto starts = starting_values(bound, attached(bound, wall), observed(bound));
  REQUIRE(starts.size() == 1);
  CHECK(starts[0][0] == doctest::Approx(0.8 * runs[0].states.row(0).maxCoeff()));
}

TEST_CASE("what an input does below a level starts between its least value and its largest") {
  Recording recording = toys::blank_recording(toys::SlidingBlock{}.info(), 100, 0.1);
  for (Eigen::Index i = 0; i < 100; ++i) recording.inputs(0, i) = i < 10 ? 0.0 : 5 + 0.05 * static_cast<double>(i - 10);
  BoundSimulator bound = bind_simulator(toys::SlidingBlock{}, {recording});
  const Hypothesis nominal = nominal_hypothesis(bound);
  bound.sizes = measure_sizes(bound, nominal, {0}, simulate_all(bound, nominal, {0}, {}, serially()));
  const double largest = recording.inputs.maxCoeff();
  for (const Eigen::VectorXd& start : starting_values(bound, attached(bound, effects::dead_zone_step()), {})) {
    CHECK(start[0] > 5);  // below, it would do nothing
    CHECK(start[0] < largest);
  }
  bound.recordings[0].inputs.setConstant(-5);
  bound.sizes = measure_sizes(bound, nominal, {0}, simulate_all(bound, nominal, {0}, {}, serially()));
  const auto of_one_value = starting_values(bound, attached(bound, effects::dead_zone_step()), {});
  REQUIRE_FALSE(of_one_value.empty());
  CHECK(of_one_value[0][0] == doctest::Approx(5 * effects::dead_zone_step().parameters[0].starts[0]));
}

TEST_CASE("times start as shares of 200 rows, fast or slow") {
  for (const double interval : {0.001, 2.0}) {
    const BoundSimulator bound = tank(interval);
    const auto starts = starting_values(bound, attached(bound, effects::first_order_lag()), observed(bound));
    REQUIRE(starts.size() == effects::first_order_lag().parameters[0].starts.size());
    CHECK(starts[1][0] == doctest::Approx(200 * interval * effects::first_order_lag().parameters[0].starts[1]));
  }
}

TEST_CASE("every combination of starting values is tried once") {
  const BoundSimulator bound =
      bind_simulator(toys::SlidingBlock{}, {toys::blank_recording(toys::SlidingBlock{}.info(), 100, 0.01)});
  const Effect effect = effects::stribeck_friction();
  std::size_t combinations = 1;
  for (const EffectParameter& parameter : effect.parameters) combinations *= parameter.starts.size();
  CHECK(starting_values(bound, attached(bound, effect), observed(bound)).size() == combinations);
}

TEST_CASE("steps of a sensor are tried only where its readings show them") {
  Recording recording = toys::blank_recording(toys::LeakyTank{}.info(), 400, 0.05);
  const auto starts = [&](double step) {
    for (Eigen::Index i = 0; i < 400; ++i) {
      const double level = 1 + std::sin(0.02 * static_cast<double>(i)) + 0.1 * std::sin(0.31 * static_cast<double>(i));
      recording.outputs(0, i) = step > 0 ? step * std::round(level / step) : level;
    }
    BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {recording});
    const Hypothesis nominal = nominal_hypothesis(bound);
    bound.sizes = measure_sizes(bound, nominal, {0}, simulate_all(bound, nominal, {0}, {}, serially()));
    const AttachedEffect steps = attached(bound, effects::quantization());
    CHECK(starting_values(bound, steps, {}).empty());
    return starting_values(bound, steps,
                           {Observed{std::vector<double>(recording.outputs.data(), recording.outputs.data() + 400),
                                     std::vector<double>(400, 0.0)}});
  };
  CHECK(starts(0).empty());
  REQUIRE(starts(0.05).size() == 1);
  CHECK(starts(0.05)[0][0] == doctest::Approx(0.05).epsilon(1e-3));
}

}  // namespace
}  // namespace surefoot::diagnosis

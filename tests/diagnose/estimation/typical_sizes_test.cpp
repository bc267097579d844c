// Typical sizes of outputs, states and forces.
#include "surefoot/diagnose/estimation/typical_sizes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "surefoot/diagnose/estimation/fit.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::SlidingBlock;

TEST_CASE("an output's deviation is that of what was measured, and 1 if it never changes") {
  Recording recording = toys::blank_recording(SlidingBlock{}.info(), 5, 0.1);
  recording.outputs.row(0) << 1, 3, std::numeric_limits<double>::quiet_NaN(), 1, 3;
  recording.outputs.row(1).setConstant(7e3);
  const Eigen::VectorXd deviations = output_deviations(bind_simulator(SlidingBlock{}, {recording}), {0});
  CHECK(deviations[0] == doctest::Approx(1));
  CHECK(deviations[1] == 1);
}

TEST_CASE("rates are changes by time, and one row alone has none") {
  const Eigen::MatrixXd states{{0.0, 1.0, 4.0}};
  CHECK(row_rates(Vec<3>(0, 0.5, 1.5), states).isApprox(Eigen::MatrixXd{{2.0, 3.0}}));
  CHECK(row_rates(Vec<1>(0), states.leftCols(1)).cols() == 0);
}

TEST_CASE("sizes are root mean squares along the simulated motion, and peaks its largest values") {
  Recording recording = toys::blank_recording(SlidingBlock{}.info(), 101, 0.01);
  recording.inputs.setConstant(2);  // 1 m/s^2 on 2 kg
  BoundSimulator bound = bind_simulator(SlidingBlock{}, {recording});
  const Hypothesis nominal = nominal_hypothesis(bound);
  const Sizes sizes = measure_sizes(bound, nominal, {0}, simulate_all(bound, nominal, {0}, {}, serially()));
  CHECK(sizes.state[1] == doctest::Approx(std::sqrt(1.0 / 3)).epsilon(0.02));  // of a speed that rises to 1 m/s
  CHECK(sizes.state_peak[0] == doctest::Approx(0.5).epsilon(0.01));
  CHECK(sizes.rate[1] == doctest::Approx(1).epsilon(1e-6));
  CHECK(sizes.effort[1] == doctest::Approx(2).epsilon(1e-6));  // [N]
  CHECK(sizes.input[0] == doctest::Approx(2));
  CHECK(sizes.time == doctest::Approx(2));  // 200 rows of 10 ms
}

TEST_CASE("the least value of an input is the one nearest to 0, but not 0") {
  Recording recording = toys::blank_recording(SlidingBlock{}.info(), 101, 0.01);
  recording.inputs.setConstant(-2);
  recording.inputs(0, 3) = 0;
  recording.inputs(0, 4) = 1.5;
  BoundSimulator bound = bind_simulator(SlidingBlock{}, {recording});
  const Hypothesis nominal = nominal_hypothesis(bound);
  const Sizes sizes = measure_sizes(bound, nominal, {0}, simulate_all(bound, nominal, {0}, {}, serially()));
  CHECK(sizes.least[0] == 1.5);
}

// A mass of 1 kg on a spring of 400 N/m that an input holds where it is.
struct StiffBench {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  SimulatorInfo info() const {
    return {.name = "stiff bench",
            .states = {{"position", "m"}, {"speed", "m/s", "N"}},
            .inputs = {{"held", "m"}},
            .outputs = {{"position_m", "m"}},
            .parameters = {}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& /*p*/) const {
    return {x[1], 400 * (u[0] - x[0]) - 40 * x[1]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};

TEST_CASE("where large forces all but cancel their size is that of the largest, not of what is left") {
  Recording recording = toys::blank_recording(StiffBench{}.info(), 1001, 0.01);
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    recording.inputs(0, row) = 0.1 * std::sin(recording.time[row]);
  }
  BoundSimulator bound = bind_simulator(StiffBench{}, {recording});
  const Hypothesis nominal = nominal_hypothesis(bound);
  const Sizes sizes = measure_sizes(bound, nominal, {0}, simulate_all(bound, nominal, {0}, {}, serially()));
  CHECK(sizes.rate[1] < 0.5);  // [m/s^2]
  CHECK(sizes.effort[1] == doctest::Approx(400 * 0.1 / std::sqrt(2.0)).epsilon(0.1));
}

}  // namespace
}  // namespace surefoot::diagnosis

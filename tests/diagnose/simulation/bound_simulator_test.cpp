// A simulator bound to its recordings.
#include "surefoot/diagnose/simulation/bound_simulator.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a bound simulator simulates as the simulator does") {
  const Recording recording = toys::tank_recording(1, 50);
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {recording});
  const SimulatedRun run =
      bound.simulate(bound, 0, nominal_parameters(bound.info), {}, recording.initial, bound.integration);
  CHECK(run.outputs == simulate_augmented(toys::LeakyTank{}, {}, recording).outputs);
}

TEST_CASE("probing gives the forces on states and the signals, row by row") {
  const Recording recording = toys::tank_recording(1, 5);
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {recording});
  Eigen::VectorXd p(2);
  p << 3, 2;
  Eigen::MatrixXd efforts, signals;
  bound.probe(bound, 0, p, Eigen::MatrixXd::Constant(1, 5, 0.5), efforts, signals);
  CHECK(signals(0, 3) == 3 * recording.inputs(0, 3));
  CHECK(efforts(0, 3) == 3 * recording.inputs(0, 3) - 2 * 0.5);
}

TEST_CASE("without recordings there is nothing to bind to") {
  CHECK_THROWS_AS(bind_simulator(toys::LeakyTank{}, {}), DiagnoseError);
}

// Says that it has two states, but has one.
struct Miscounted : toys::LeakyTank {
  SimulatorInfo info() const {
    SimulatorInfo info = LeakyTank::info();
    info.states.push_back(info.states[0]);
    return info;
  }
};

TEST_CASE("a state that has another size than info() says is refused") {
  CHECK_THROWS_WITH_AS(bind_simulator(Miscounted{}, {toys::tank_recording(1, 50)}),
                       "simulator 'tank': State has 1 components, but info() names 2", DiagnoseError);
}

TEST_CASE("sizes are of what is finite") {
  Eigen::RowVectorXd values(4);
  values << 3, std::numeric_limits<double>::quiet_NaN(), -3, 3;
  CHECK(root_mean_square(values) == doctest::Approx(3));
  CHECK(standard_deviation(values) == doctest::Approx(std::sqrt(8.0)));
  CHECK(standard_deviation(Eigen::RowVectorXd::Constant(1, 3)) == 0);
}

}  // namespace
}  // namespace surefoot::diagnosis

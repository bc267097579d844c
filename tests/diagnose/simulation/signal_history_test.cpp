// The past of a signal, and simulations in which it comes late.
#include "surefoot/diagnose/simulation/signal_history.hpp"

#include <doctest/doctest.h>

#include "surefoot/diagnose/simulate_augmented.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/servo_pendulum.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a ramp comes late by the delay, and the first value counts before there was any") {
  SignalHistory history;
  CHECK(history.delayed(1, 3, 0.5) == 3);
  CHECK(history.delayed(2, 4, 5) == 3);
  CHECK(history.delayed(3, 5, 0.25) == doctest::Approx(4.75));
  CHECK(history.delayed(4, 6, 1.5) == doctest::Approx(4.5));
  CHECK(history.delayed(5, 7, 0) == 7);
}

TEST_CASE("or it was zero before there was any") {
  SignalHistory history;
  CHECK(history.delayed(1, 3, 0.5, true) == 0);
  CHECK(history.delayed(1.5, 4, 0.5, true) == 3);
  CHECK(history.delayed(2, 5, 0.75, true) == doctest::Approx(3.5));
}

TEST_CASE("a step that was taken back is forgotten") {
  SignalHistory history;
  history.delayed(1, 0, 0);
  history.delayed(3, 100, 0);
  CHECK(history.delayed(2, 1, 0.5) == doctest::Approx(0.5));
  CHECK(history.time.size() == 2);
}

TEST_CASE("a signal that is late by nothing changes nothing, and a late one makes the loop swing") {
  const Recording recording = toys::servo_recordings(toys::machine({}, {}), 1, 1).front();
  const auto with = [&](double delay) {
    return simulate_augmented(toys::ServoPendulum{}, toys::machine({}, {{"input_delay", "duty", {}, {}, {delay}}}),
                              recording)
        .outputs;
  };
  const Eigen::MatrixXd plain =
      simulate_augmented(toys::ServoPendulum{}, toys::machine({}, {}), recording).outputs;
  CHECK((with(0) - plain).cwiseAbs().maxCoeff() < 1e-9);
  const double late = (with(0.01) - plain).norm(), later = (with(0.02) - plain).norm();
  CHECK(late > 1e-3 * plain.norm());
  CHECK(later > 1.5 * late);
  CHECK((with(0.0101) - with(0.01)).norm() < 0.05 * late);  // smooth in the delay
}

}  // namespace
}  // namespace surefoot::diagnosis

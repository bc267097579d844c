// The choice of the integration.
#include "surefoot/diagnose/estimation/choose_integration.hpp"

#include <doctest/doctest.h>

#include <utility>

#include "surefoot/diagnose/estimation/fit.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/walking_robot.hpp"

namespace surefoot::diagnosis {
namespace {

Integration chosen(double residual_size, double leak) {
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 100)});
  Hypothesis hypothesis = nominal_hypothesis(bound);
  hypothesis.parameters[1] = leak;
  return choose_integration(bound, hypothesis, Vec<1>(residual_size), bound.integration, {0}, serially());
}

TEST_CASE("a coarse model is integrated coarsely, an exact one finely") {
  const Integration coarse = chosen(0.1, 1), fine = chosen(1e-12, 1);
  CHECK(coarse.order == 2);
  CHECK(coarse.step == doctest::Approx(0.075));  // one step a row, with some slack
  CHECK(fine.order == 4);
  CHECK(fine.step == doctest::Approx(0.05 / 8));
}

TEST_CASE("the error of an integration that is chosen is small against the residuals") {
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 100)});
  const Hypothesis nominal = nominal_hypothesis(bound);
  Integration exact;
  exact.step = 0.001;
  const SimulatedRun reference = simulate(bound, nominal, 0, exact);
  for (const double size : {1e-2, 1e-4, 1e-6}) {
    const SimulatedRun run = simulate(bound, nominal, 0, chosen(size, 1));
    CHECK(root_mean_square(run.outputs.row(0) - reference.outputs.row(0)) < 0.06 * size);
  }
}

TEST_CASE("fits that are only compared are integrated as coarsely as a quarter of the residuals allows") {
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 100)});
  const Hypothesis nominal = nominal_hypothesis(bound);
  const auto error_of = [&](const Integration& one) {
    const SimulatedRun run = simulate(bound, nominal, 0, one), exact = simulate(bound, nominal, 0, {.step = 0.001});
    return root_mean_square(run.outputs.row(0) - exact.outputs.row(0));
  };
  const Integration coarsest = chosen(0.1, 1);
  const double size = 10 * error_of(coarsest);
  const auto [fitting, screening] = choose_integrations(bound, nominal, Vec<1>(size), {}, {0}, serially());
  CHECK(is_finer(fitting, screening));
  CHECK(screening.order == coarsest.order);
  CHECK(screening.step == coarsest.step);
  const auto small = choose_integrations(bound, nominal, Vec<1>(size / 10), {}, {0}, serially());
  CHECK(is_finer(small.screening, screening));
  CHECK(error_of(small.screening) < 0.3 * size / 10);
}

TEST_CASE("the integration is fine enough for the recording that needs it most, wherever it stands") {
  Recording calm = toys::tank_recording(0, 100), lively = calm;
  calm.initial.setZero();
  calm.inputs.setZero();  // an empty tank stays empty, however coarsely
  calm.outputs.setZero();
  const auto choice = [](const std::vector<Recording>& recordings) {
    const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, recordings);
    Hypothesis fast = nominal_hypothesis(bound);
    fast.parameters[1] = 5;
    return choose_integration(bound, fast, Vec<1>(1e-4), {}, {0, 1}, serially());
  };
  const Integration easy = choice({calm, calm}), first = choice({calm, lively}), last = choice({lively, calm});
  CHECK(first.order > easy.order);
  CHECK(first.order == last.order);
  CHECK(first.step == last.step);
}

TEST_CASE("an integration that is chosen again is as fine as before, not finer") {
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 100)});
  for (const double size : {0.1, 1e-6, 1e-12}) {
    const Integration once = chosen(size, 1);
    const Integration twice = choose_integration(bound, nominal_hypothesis(bound), Vec<1>(size), once, {0}, serially());
    CHECK(twice.step == once.step);
    CHECK(twice.order == once.order);
  }
}

TEST_CASE("what is much faster than rows is integrated in as many steps as it takes to run") {
  const auto fast = [](double leak) {
    BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 1000)});
    Hypothesis hypothesis = nominal_hypothesis(bound);
    hypothesis.parameters[1] = leak;
    bound.integration = integration_that_runs(bound, hypothesis, serially());
    return std::pair{bound.integration, choose_integration(bound, hypothesis, Vec<1>(1e-3), bound.integration, {0},
                                                           serially())};
  };
  const double row = 0.05;
  CHECK(fast(1).first.step == 0);  // one step a row will do
  const auto [runs, chosen] = fast(30 / row);  // 30 time constants a row; Runge-Kutta's fourth order bears 2.8 a step
  CHECK(runs.step > row / 16);
  CHECK(runs.step < row / 10);
  CHECK(chosen.step <= runs.step);
  CHECK(chosen.step > row / 128);
}

TEST_CASE("an integrator that is unstable in steps of a row is so though it stays finite") {
  const double row = 0.05;
  BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 200)});
  Hypothesis hypothesis = nominal_hypothesis(bound);
  hypothesis.parameters[1] = 2.9 / row;  // errors grow by a fifth a step: Runge-Kutta's fourth order bears 2.8
  bound.integration.step = 0;
  REQUIRE(simulate(bound, hypothesis, 0, bound.integration).finite);
  const Integration needed = integration_that_runs(bound, hypothesis, serially());
  CHECK(needed.step > 0);
  CHECK(needed.step < 0.6 * row);
}

TEST_CASE("steps are so short that all recordings run, not only the calmest") {
  Recording calm = toys::tank_recording(0, 1000), lively = calm;
  calm.initial.setZero();
  calm.inputs.setZero();  // an empty tank stays empty, however coarsely
  BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {calm, lively});
  Hypothesis hypothesis = nominal_hypothesis(bound);
  hypothesis.parameters[1] = 600;
  bound.integration = integration_that_runs(bound, hypothesis, serially());
  CHECK(simulate(bound, hypothesis, 1, bound.integration).finite);
}

TEST_CASE("a map is left as it is") {
  const auto walks = toys::walk_recordings([](Pose2 moved, Pose2) { return moved; }, false, 1, 1);
  const BoundSimulator bound = bind_simulator(toys::WalkingRobot{}, walks);
  const Integration now = bound.integration;
  const Integration after = choose_integration(bound, nominal_hypothesis(bound), Vec<3>(1, 1, 1), now, {0}, serially());
  CHECK(after.order == now.order);
  CHECK(after.step == now.step);
}

}  // namespace
}  // namespace surefoot::diagnosis

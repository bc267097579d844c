// Inputs as functions of time: held, interpolated, late.
#include "surefoot/diagnose/simulation/input_signal.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"

namespace surefoot::diagnosis {
namespace {

// Input 0 is held, input 1 interpolated.
SimulatorInfo two_inputs() {
  return {.name = "two",
          .states = {},
          .inputs = {{"held", "1"}, {"linear", "1", InputHold::linear}},
          .outputs = {},
          .parameters = {}};
}

// Rows at unequal intervals.
Recording unequal() {
  Recording recording;
  recording.time.resize(5);
  recording.time << 2.0, 2.1, 2.4, 2.5, 3.0;
  recording.inputs.resize(2, 5);
  recording.inputs << 1, -3, 4, 2, 9,  //
      0, 1, 4, 5, 10;
  return recording;
}

TEST_CASE("inputs that are not late are held, or interpolated, anywhere in a row") {
  const SimulatorInfo info = two_inputs();
  const Recording recording = unequal();
  InputSignal<Vec<2>> u(info, recording);
  u.go_to(1);
  for (const double share : {0.0, 0.5, 1.0}) {
    const Vec<2> value = u.between(2.2, 0.1, share);
    CHECK(value[0] == -3);
    CHECK(value[1] == doctest::Approx(2 + share));
  }
  CHECK(u.at_row(3) == Vec<2>(2, 5));
}

TEST_CASE("what is logged after it acted acts since the row before, late or not") {
  SimulatorInfo info = two_inputs();
  info.inputs[0].hold = {};
  const Recording recording = unequal();
  InputSignal<Vec<2>> u(info, recording, {InputHold::before, InputHold::zero_order});
  CHECK(u.at_row(1)[0] == 4);
  CHECK(u.at_row(4)[0] == 9);  // the last row has no other
  u.go_to(1);
  CHECK(u.between(2.2, 0.1, 0.5)[0] == 4);
  u.delay(0, 100);
  u.go_to(3);
  CHECK(u.between(recording.time[3], 0.1, 0.5)[0] ==
        doctest::Approx(-3));  // as in the first row, which acts from row 0 on
  info.inputs[0].hold = InputHold::zero_order;
  CHECK(InputSignal<Vec<2>>(info, recording, {InputHold::before, InputHold::zero_order}).at_row(1)[0] ==
        -3);  // the model says
}

TEST_CASE("a band-limited input goes smoothly through its rows, late or not") {
  SimulatorInfo info = two_inputs();
  Recording recording;
  recording.time.setLinSpaced(60, 0, 5.9);
  recording.inputs.setZero(2, 60);
  recording.inputs.row(1) = (6 * recording.time.array()).sin();
  const std::vector<InputHold> found{InputHold::zero_order, InputHold::band_limited};
  InputSignal<Vec<2>> u(info, recording, found);
  u.go_to(30);
  CHECK(u.between(3.0, 0.1, 0)[1] == doctest::Approx(std::sin(18.0)));
  CHECK(std::abs(u.between(3.0, 0.1, 0.5)[1] - std::sin(18.3)) < 1e-3);
  CHECK_FALSE(u.steady());
  u.delay(1, 0.05);
  CHECK(std::abs(u.between(3.0, 0.1, 0)[1] - std::sin(17.7)) < 1e-3);
  info.inputs[1].hold = InputHold::zero_order;  // the model says so
  InputSignal<Vec<2>> held(info, recording, found);
  held.go_to(30);
  CHECK(held.between(3.0, 0.1, 0.5)[1] == recording.inputs(1, 30));
}

TEST_CASE("inputs are steady during a step unless one is interpolated") {
  SimulatorInfo info = two_inputs();
  const Recording recording = unequal();
  CHECK_FALSE(InputSignal<Vec<2>>(info, recording).steady());
  info.inputs[1].hold = InputHold::zero_order;
  InputSignal<Vec<2>> u(info, recording);
  CHECK(u.steady());
  u.delay(0, 0.15);
  CHECK(u.steady());
  u.go_to(2);
  CHECK(u.between(2.4, 0.1, 0) == u.between(2.4, 0.1, 1));
}

TEST_CASE("it is known when a late held input changes next") {
  const SimulatorInfo info = two_inputs();
  const Recording recording = unequal();
  InputSignal<Vec<2>> u(info, recording);
  CHECK_FALSE(u.late());
  u.delay(0, 0.15);
  CHECK(u.late());
  u.go_to(2);  // changes at 2.25, 2.55, 2.65 and 3.15
  CHECK(u.next_change(2.4, 2.5) == 2.5);
  u.go_to(3);
  CHECK(u.next_change(2.5, 3.0) == doctest::Approx(2.55));
  CHECK(u.next_change(2.55, 3.0) == doctest::Approx(2.65));
  CHECK(u.next_change(2.65, 3.0) == 3.0);
}

TEST_CASE("a late input never changes at the time it is asked from, however it is rounded") {
  const SimulatorInfo info = two_inputs();
  Recording recording;
  recording.time.setLinSpaced(600, 0, 3);
  recording.inputs.setRandom(2, 600);
  Rng rng(2);
  for (int k = 0; k < 200; ++k) {
    InputSignal<Vec<2>> u(info, recording);
    u.delay(0, 0.05 * rng.uniform());
    for (const Eigen::Index row : {Eigen::Index{20}, Eigen::Index{300}, Eigen::Index{598}}) {
      u.go_to(row);
      double t = recording.time[row];
      int changes = 0;
      for (double next = t; (next = u.next_change(t, recording.time[row + 1])) < recording.time[row + 1]; ++changes) {
        REQUIRE(next > t);
        t = next;
      }
      CHECK(changes <= 1);
    }
  }
}

TEST_CASE("a late held input is its mean over the step, a late interpolated one its value") {
  const SimulatorInfo info = two_inputs();
  const Recording recording = unequal();
  InputSignal<Vec<2>> u(info, recording);
  u.delay(0, 0.15);
  u.delay(1, 0.15);
  u.go_to(2);
  const Vec<2> value = u.between(2.4, 0.1, 0.5);  // a quarter of a second to a third before the row at 2.4
  CHECK(value[0] == doctest::Approx(-3));
  CHECK(value[1] == doctest::Approx(3));
  u.go_to(3);
  CHECK(u.between(2.5, 0.2, 0)[0] == doctest::Approx((0.05 * -3 + 0.1 * 4 + 0.05 * 2) / 0.2));
  CHECK(u.between(2.5, 0.2, 1)[0] == u.between(2.5, 0.2, 0)[0]);
}

TEST_CASE("what was not told before the first row was zero, and what is told there arrives late") {
  const SimulatorInfo info = two_inputs();
  Recording recording = unequal();
  recording.inputs.row(1).array() += 1;
  InputSignal<Vec<2>> u(info, recording);
  u.delay(0, 0.05, true);
  u.delay(1, 0.05, true);
  u.go_to(0);
  CHECK(u.next_change(2.0, 2.1) == doctest::Approx(2.05));
  CHECK(u.next_change(2.05, 2.1) == 2.1);
  CHECK(u.between(2.0, 0.04, 0.5) == Vec<2>(0, 0));
  CHECK(u.between(2.0, 0.1, 0)[0] == doctest::Approx(0.5));  // half of the step
  const Vec<2> arrived = u.between(2.06, 0.02, 0);
  CHECK(arrived[0] == doctest::Approx(1));
  CHECK(arrived[1] == doctest::Approx(1.1));
}

TEST_CASE("before the first row the first value counts, after the last the last") {
  const SimulatorInfo info = two_inputs();
  const Recording recording = unequal();
  InputSignal<Vec<2>> u(info, recording);
  u.delay(0, 10);
  u.delay(1, 10);
  u.go_to(4);
  CHECK(u.between(3.0, 0.5, 0)[0] == doctest::Approx(1));
  CHECK(u.between(3.0, 0.5, 0)[1] == 0);
  InputSignal<Vec<2>> punctual(info, recording);
  punctual.go_to(4);
  CHECK(punctual.between(3.0, 0.5, 1)[1] == 10);
}

TEST_CASE("delays of one input add up, and none leaves it as it is") {
  const SimulatorInfo info = two_inputs();
  const Recording recording = unequal();
  InputSignal<Vec<2>> twice(info, recording), once(info, recording), none(info, recording);
  twice.delay(0, 0.05);
  twice.delay(0, 0.08);
  once.delay(0, 0.13);
  none.delay(0, 0);
  for (Eigen::Index row = 0; row < 5; ++row) {
    const double t = recording.time[row];
    twice.go_to(row);
    once.go_to(row);
    none.go_to(row);
    CHECK(twice.between(t, 0.05, 0)[0] == doctest::Approx(once.between(t, 0.05, 0)[0]));
    CHECK(none.between(t, 0.05, 0)[0] == recording.inputs(0, row));
  }
}

TEST_CASE("a delay loses and adds nothing: the integral of the late input is that of the punctual one, later") {
  const SimulatorInfo info = two_inputs();
  Recording recording;
  recording.time.setLinSpaced(200, 0, 1.99);
  recording.inputs.setZero(2, 200);
  Rng rng(1);
  for (Eigen::Index row = 50; row < 150; ++row) recording.inputs(0, row) = rng.normal();
  InputSignal<Vec<2>> u(info, recording);
  u.delay(0, 0.0237);
  double sum = 0;
  for (Eigen::Index row = 0; row < 200; ++row) {
    u.go_to(row);
    for (int part = 0; part < 3; ++part) sum += u.between(recording.time[row] + part * 0.01 / 3, 0.01 / 3, 0.5)[0] / 3;
  }
  CHECK(sum == doctest::Approx(recording.inputs.row(0).sum()).epsilon(1e-9));
}

}  // namespace
}  // namespace surefoot::diagnosis

// Effects in a sensor.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/quantization.hpp"
#include "surefoot/diagnose/effects/sensor_bias.hpp"
#include "surefoot/diagnose/effects/sensor_delay.hpp"
#include "surefoot/diagnose/effects/sensor_drift.hpp"
#include "surefoot/diagnose/effects/sensor_scale.hpp"

namespace surefoot {
namespace {

std::vector<double> read(const Effect& effect, const std::vector<double>& p, const std::vector<double>& time,
                         std::vector<double> readings) {
  effect.sensor({time, readings}, p);
  return readings;
}

const std::vector<double> uneven = {2, 2.1, 2.15, 2.4, 3};

TEST_CASE("bias and scale change every reading alike") {
  CHECK(read(effects::sensor_bias(), {0.5}, uneven, {1, 2, 3, 4, -5}) == std::vector<double>{1.5, 2.5, 3.5, 4.5, -4.5});
  CHECK(read(effects::sensor_scale(), {0.5}, uneven, {1, 2, 0, 4, -5}) == std::vector<double>{1.5, 3, 0, 6, -7.5});
}

TEST_CASE("a drift grows from the first row on") {
  const auto y = read(effects::sensor_drift(), {10}, uneven, {1, 1, 1, 1, 1});
  CHECK(y[0] == 1);
  CHECK(y[2] == doctest::Approx(2.5));
  CHECK(y[4] == doctest::Approx(11));
}

TEST_CASE("a drift that settles has made 63 % of its way after its time constant") {
  const auto y = read(effects::sensor_drift_settling(), {2, 0.4}, uneven, {1, 1, 1, 1, 1});
  CHECK(y[0] == 1);
  CHECK(y[3] == doctest::Approx(1 + 2 * 0.632121).epsilon(1e-6));
  CHECK(y[4] < 3);
}

TEST_CASE("a drift that is bent goes with the square of time as well") {
  const auto y = read(effects::sensor_drift_bent(), {10, -5}, uneven, {1, 1, 1, 1, 1});
  CHECK(y[0] == 1);
  CHECK(y[3] == doctest::Approx(1 + 4 - 0.8));
  CHECK(y[4] == doctest::Approx(1 + 10 - 5));
}

TEST_CASE("a drift that sets in midway has made half of its way then, and none in the first row") {
  const auto y = read(effects::sensor_drift_midway(), {2, 0.4, 0.01}, uneven, {1, 1, 1, 1, 1});
  CHECK(y[0] == 1);
  CHECK(y[3] == doctest::Approx(2));
  CHECK(y[4] == doctest::Approx(3));
}

TEST_CASE("a late sensor reads a ramp late, between rows of any spacing") {
  for (const double delay : {0.0, 0.03, 0.05, 0.2, 0.7}) {
    std::vector<double> ramp;
    for (const double t : uneven) ramp.push_back(3 * t);
    const auto y = read(effects::sensor_delay(), {delay}, uneven, ramp);
    for (std::size_t i = 0; i < y.size(); ++i) CHECK(y[i] == doctest::Approx(3 * std::max(2.0, uneven[i] - delay)));
  }
  CHECK(read(effects::sensor_delay(), {2}, {0, 1, 2, 3}, {5, 6, 7, 8}) == std::vector<double>{5, 5, 5, 6});
  CHECK(read(effects::sensor_delay_in_motion(), {1.5}, {0, 1, 2, 3}, {5, 6, 8, 8}) ==
        std::vector<double>{3.5, 4.5, 5.5, 7});
  CHECK(read(effects::sensor_delay_in_motion(), {0.1}, {0}, {5}) == std::vector<double>{5});
  CHECK(read(effects::sensor_delay(), {0.1}, {0}, {5}) == std::vector<double>{5});
  CHECK(read(effects::sensor_delay(), {0.1}, {}, {}).empty());
}

TEST_CASE("soft rounding is monotone, odd, and keeps multiples of the step nearly as they are") {
  double last = -1e9;
  for (double x = -3; x < 3; x += 0.001) {
    const double y = effects::soft_round(x);
    CHECK(y >= last - 1e-12);
    CHECK(std::abs(y - x) < 0.5);
    CHECK(effects::soft_round(-x) == doctest::Approx(-y));
    last = y;
  }
  CHECK(effects::soft_round(2) == doctest::Approx(2));
  for (const double off : {-0.25, 0.25}) CHECK(std::abs(effects::soft_round(2 + off) - 2) < 0.03);
}

TEST_CASE("a sensor with sharp edges rounds, but for a hundredth of a step beside them") {
  const auto rounded = read(effects::sharpened(effects::quantization()), {0.1}, {0, 1, 2}, {0.147, 0.153, -0.247});
  CHECK(rounded[0] == doctest::Approx(0.1).epsilon(0.02));
  CHECK(rounded[1] == doctest::Approx(0.2).epsilon(0.02));
  CHECK(rounded[2] == doctest::Approx(-0.2).epsilon(0.02));
  const auto cut = read(effects::sharpened(effects::quantization_floor()), {0.1}, {0, 1}, {0.197, -0.103});
  CHECK(cut[0] == doctest::Approx(0.1).epsilon(0.02));
  CHECK(cut[1] == doctest::Approx(-0.2).epsilon(0.02));
}

TEST_CASE("a sensor in steps reads multiples of its step") {
  const auto y = read(effects::quantization(), {0.1}, {0, 1, 2}, {0.12, 0.31, -0.48});
  CHECK(y[0] == doctest::Approx(0.1).epsilon(0.02));
  CHECK(y[1] == doctest::Approx(0.3).epsilon(0.02));
  CHECK(y[2] == doctest::Approx(-0.5).epsilon(0.02));
}

}  // namespace
}  // namespace surefoot

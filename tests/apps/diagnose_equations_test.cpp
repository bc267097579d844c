// The equations of a model file against the same in C++.
#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

#include "apps/diagnose/equations.hpp"
#include "apps/diagnose/evaluate_once.hpp"
#include "surefoot/core/rng.hpp"
#include "tests/apps/diagnose_models.hpp"

using diagnose_program::Channels;
using diagnose_program::MapModel;
using diagnose_program::OdeModel;
using diagnose_program::parse_model_file;
using diagnose_test::servo_model;
using diagnose_test::walk_model;

namespace {

surefoot::Recording servo_bench() {
  surefoot::Recording recording;
  recording.name = "rec.csv";
  recording.constants = {{"mass_kg", 0.5}, {"length_m", 0.1}, {"kp", 5}, {"vin_V", 7.4}};
  return recording;
}

double value(const std::string& expression) {
  return diagnose_program::evaluate_once({expression, "test"}, {{"a", 2}, {"b", -3}, {"c", 0.5}});
}

Channels vector(std::initializer_list<double> values) {
  Channels result(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

}  // namespace

TEST_CASE("a pendulum from a file moves like one in C++") {
  OdeModel model = OdeModel(parse_model_file(servo_model, "servo.toml")).for_recording(servo_bench());
  surefoot::Rng rng(1);
  for (int round = 0; round < 1000; ++round) {
    const Eigen::VectorXd p =
        Eigen::Vector3d(0.3 + rng.uniform(), 0.5 + 3 * rng.uniform(), 0.001 + 0.1 * rng.uniform());
    const double theta = 4 * rng.uniform() - 2, omega = 10 * rng.uniform() - 5, goal = 2 * rng.uniform() - 1;
    model.prepare(p);
    const Channels rate = model.derivative(vector({theta, omega}), vector({goal}), p);
    const double duty = std::min(std::max(5 * (goal - theta), -1.0), 1.0);
    const double tau = p[0] / p[1] * (7.4 * duty - p[0] * omega);
    const double inertia = p[2] + 0.5 * 0.1 * 0.1;
    CHECK(rate[0] == omega);
    CHECK(rate[1] == doctest::Approx((tau - 0.5 * 9.81 * 0.1 * std::sin(theta)) / inertia).epsilon(1e-12));
    CHECK(model.effort(vector({theta, omega}), vector({goal}), p)[1] == doctest::Approx(inertia).epsilon(1e-12));
    CHECK(model.effort(vector({theta, omega}), vector({goal}), p)[0] == 1);
    CHECK(model.observe(vector({theta, omega}), vector({goal}), p)[0] == theta);
  }
}

TEST_CASE("a tap sees and changes the lets that depend on states or inputs and that rates need") {
  OdeModel model = OdeModel(parse_model_file(servo_model, "servo.toml")).for_recording(servo_bench());
  CHECK(model.info().signals == std::vector<std::string>{"duty", "tau"});
  const Eigen::VectorXd p = Eigen::Vector3d(1.6, 3.6, 0.012);
  model.prepare(p);
  const Channels x = vector({0.3, 0}), u = vector({0.35});
  std::vector<int> seen;
  const Channels same = model.derivative(x, u, p, [&](int i, double signal) {
    seen.push_back(i);
    return signal;
  });
  CHECK(seen == std::vector<int>{0, 1});
  CHECK(same == model.derivative(x, u, p));
  const Channels changed = model.derivative(x, u, p, [](int i, double signal) { return i == 0 ? 0.0 : signal; });
  CHECK(changed[1] == doctest::Approx(-0.5 * 9.81 * 0.1 * std::sin(0.3) / 0.017).epsilon(1e-12));
}

TEST_CASE("a force by its name in the rates moves all velocities as the mass matrix says") {
  OdeModel model = OdeModel(parse_model_file(diagnose_test::crane_model, "crane.toml"));
  const Eigen::VectorXd p = Eigen::Vector2d(1.3, 0.4);
  model.prepare(p);
  surefoot::Rng rng(2);
  for (int round = 0; round < 100; ++round) {
    const double a = 4 * rng.uniform() - 2, f = rng.uniform(), c = rng.uniform() - 2;
    const Channels x = vector({1, rng.uniform(), a, rng.uniform()}), u = vector({rng.uniform()});
    Eigen::Matrix2d mass;  // of trolley and load
    mass << p[0] + p[1], p[1] * 0.5 * std::cos(a), p[1] * 0.5 * std::cos(a), p[1] * 0.25;
    const Eigen::Vector2d expected = mass.inverse() * Eigen::Vector2d(f, c);
    const Channels added = model.response(x, u, p, vector({7, f, 7, c}));  // nothing pushes positions
    CHECK(added[0] == 0);
    CHECK(added[1] == doctest::Approx(expected[0]).epsilon(1e-12));
    CHECK(added[2] == 0);
    CHECK(added[3] == doctest::Approx(expected[1]).epsilon(1e-12));
    const auto units = model.unit_responses(x, u, {3, 1});
    CHECK(units[0] == model.response(x, u, p, vector({0, 0, 0, 1})));
    CHECK(units[1] == model.response(x, u, p, vector({0, 1, 0, 0})));
    CHECK(model.derivative(x, u, p)[1] * (p[0] + p[1] * std::pow(std::sin(a), 2)) ==
          doctest::Approx(u[0] + p[1] * std::sin(a) * (0.5 * x[3] * x[3] + 9.81 * std::cos(a))));
  }
}

TEST_CASE("copies of a model do not disturb each other") {
  const OdeModel first = OdeModel(parse_model_file(servo_model, "servo.toml")).for_recording(servo_bench());
  OdeModel second = first;
  const Eigen::VectorXd p = Eigen::Vector3d(1.6, 3.6, 0.012), q = Eigen::Vector3d(0.5, 3.6, 0.05);
  OdeModel third = first;
  second.prepare(p);
  third.prepare(q);
  const Channels x = vector({0.3, 0.5}), u = vector({0.35});
  const Channels before = second.derivative(x, u, p);
  CHECK(third.derivative(x, u, q) != before);
  CHECK(second.derivative(x, u, p) == before);
  third = second;
  CHECK(third.derivative(x, u, p) == before);
  const OdeModel moved = std::move(second);
  CHECK(moved.derivative(x, u, p) == before);
}

TEST_CASE("states of a fixed size give the bits that those of any size do") {
  const auto file = parse_model_file(servo_model, "servo.toml");
  const OdeModel any = OdeModel(file).for_recording(servo_bench());
  const Eigen::VectorXd p = Eigen::Vector3d(1.6, 3.6, 0.012);
  const Channels u = vector({0.35});
  diagnose_program::with_ode_model(file, [&](const auto& simulator) {
    using State = typename std::decay_t<decltype(simulator)>::State;
    CHECK(State::RowsAtCompileTime == 2);
    const auto fixed = simulator.for_recording(servo_bench());
    State x;
    x << 0.3, -0.7;
    const Channels same = vector({0.3, -0.7});
    CHECK(fixed.derivative(x, u, p) == any.derivative(same, u, p));
    CHECK(fixed.effort(x, u, p) == any.effort(same, u, p));
    CHECK(fixed.observe(x, u, p) == any.observe(same, u, p));
  });
}

TEST_CASE("a rate without some signals is what it is with them at zero") {
  const OdeModel model = OdeModel(parse_model_file(servo_model, "servo.toml")).for_recording(servo_bench());
  const Eigen::VectorXd p = Eigen::Vector3d(1.6, 3.6, 0.012);
  const Channels x = vector({0.3, -0.7}), u = vector({0.35});
  for (const std::vector<bool>& held : {std::vector{false, false}, {true, false}, {false, true}, {true, true}}) {
    const Channels rate = model.derivative(
        x, u, p, [&](int i, double signal) { return held[static_cast<std::size_t>(i)] ? 0.0 : signal; });
    CHECK(model.rate_without(held, 0, x, u) == rate[0]);
    CHECK(model.rate_without(held, 1, x, u) == rate[1]);
  }
  const OdeModel copy = model;
  CHECK(copy.rate_without({true, true}, 1, x, u) == model.rate_without({true, true}, 1, x, u));
}

TEST_CASE("a recording without a constant of the model is refused") {
  const OdeModel model(parse_model_file(servo_model, "servo.toml"));
  surefoot::Recording recording = servo_bench();
  recording.constants.erase("kp");
  CHECK_THROWS_WITH_AS(model.for_recording(recording),
                       "rec.csv: the model wants the constant 'kp'; add a first line '# kp: number'",
                       surefoot::DiagnoseError);
}

TEST_CASE("a map gives next values") {
  MapModel model(parse_model_file(walk_model, "walk.toml"));
  const Eigen::VectorXd p = Eigen::VectorXd::Constant(1, 1.5);
  model.prepare(p);
  const Channels next = model.next(vector({1, 2, 0.5}), vector({0.1, 0.2}), p);
  CHECK(next[0] == doctest::Approx(1 + 0.15 * std::cos(0.5)).epsilon(1e-12));
  CHECK(next[1] == doctest::Approx(2 + 0.15 * std::sin(0.5)).epsilon(1e-12));
  CHECK(next[2] == doctest::Approx(0.7).epsilon(1e-12));
  CHECK(model.info().planar->heading == 2);
}

TEST_CASE("expressions mean what they mean on paper") {
  CHECK(value("-a^2") == -4);
  CHECK(value("a^-1") == 0.5);
  CHECK(value("2^3^2") == 512);
  CHECK(value("a - b - c") == 4.5);
  CHECK(value("a/b/c") == doctest::Approx(-4.0 / 3));
  CHECK(value("a < b ? 1 : a > b ? 2 : 3") == 2);
  CHECK(value("(a >= 2) + (a != 2) + (b == -3)") == 2);
  CHECK(value("a > 0 && b > 0 || c > 0") == 1);
  CHECK(value("pi") == doctest::Approx(std::numbers::pi).epsilon(1e-15));
  CHECK(value("log(exp(a))") == doctest::Approx(2));
  CHECK(value("sign(b) + sign(a) + sign(0)") == 0);
  CHECK(value("floor(-c) + floor(a)") == 1);
  CHECK(value("min(a, b, c) + max(a, b, c)") == -1);
  CHECK(value("abs(b)") == 3);
  CHECK(value("atan2(1, -1)") == doctest::Approx(0.75 * std::numbers::pi));
  CHECK(value("sqrt(a) * sqrt(a)") == doctest::Approx(2));
  CHECK(value("sinh(c)^2 - cosh(c)^2 + tanh(0)") == doctest::Approx(-1));
  CHECK(value("asin(c) + acos(c)") == doctest::Approx(std::numbers::pi / 2));
  CHECK(value("1e-3*1E3 + .5") == 1.5);
}

TEST_CASE("two operations at once give the bits of one after the other") {
  const auto of = [](char symbol, double left, double right) {
    return symbol == '+' ? left + right : symbol == '-' ? left - right : symbol == '*' ? left * right : left / right;
  };
  const double a = 0.1, b = 0.7, c = -1.3, d = 2.9;
  const std::string symbols = "+-*/";
  for (const char first : symbols) {
    for (const char second : symbols) {
      for (const char third : symbols) {
        const std::string inside = std::string("(theta") + first + "omega)", last(1, third);
        std::string model =
            diagnose_test::with(servo_model, "\"omega\"", "\"(" + inside + second + "goal)" + last + "kt\"");
        model = diagnose_test::with(model, "\"theta\"", "\"kt" + last + "(goal" + second + inside + ")\"");
        OdeModel equations = OdeModel(parse_model_file(model, "a.toml")).for_recording(servo_bench());
        const Eigen::VectorXd p = Eigen::Vector3d(d, 3.6, 0.012);
        equations.prepare(p);
        const double inner = of(first, a, b);
        CHECK(equations.derivative(vector({a, b}), vector({c}), p)[0] == of(third, of(second, inner, c), d));
        CHECK(equations.observe(vector({a, b}), vector({c}), p)[0] == of(third, d, of(second, c, inner)));
      }
    }
  }
}

TEST_CASE("what cannot be computed is not finite, and nothing is thrown") {
  OdeModel model(
      parse_model_file(diagnose_test::with(servo_model, "\"omega\"", "\"sqrt(theta) + log(omega)/omega\""), "a.toml"));
  const Eigen::VectorXd p = Eigen::Vector3d(1.6, 3.6, 0.012);
  model.prepare(p);
  CHECK(!std::isfinite(model.derivative(vector({-1, 0}), vector({0}), p)[0]));
  CHECK_THROWS_AS(value("1/0"), surefoot::DiagnoseError);
  CHECK_THROWS_AS(value("max(sqrt(-1), 1)"), surefoot::DiagnoseError);
}

#include "surefoot/forest/leaf.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/core/rng.hpp"

namespace surefoot {
namespace {

// Records of two inputs, two outputs and, if asked for, a weight.
struct Table {
  std::vector<float> numbers;
  bool weighted = false;
  std::size_t stride() const { return weighted ? 5 : 4; }
  LeafSamples samples() const { return {numbers.data(), numbers.size() / stride(), stride(), 2, 2, weighted}; }
};

template <LeafModel Leaf>
std::vector<float> fit(const Table& table, const LeafOptions& options = {}) {
  std::vector<float> parameters(Leaf::parameters(2, 2));
  Leaf::fit(table.samples(), options, parameters);
  return parameters;
}

template <LeafModel Leaf>
std::array<double, 2> predict(const std::vector<float>& parameters, float x0, float x1) {
  const std::array<float, 2> x{x0, x1};
  std::array<double, 2> sum{};
  Leaf::add(parameters.data(), x.data(), 2, 2, sum.data());
  return sum;
}

Table plane(int count) {  // outputs 1 + 2 a - b and -3 + 0.5 b
  Table table;
  Rng rng(1);
  for (int i = 0; i < count; ++i) {
    const auto a = static_cast<float>(rng.uniform(10, 11));  // away from zero, and of unequal spread
    const auto b = static_cast<float>(rng.uniform(-100, 100));
    table.numbers.insert(table.numbers.end(), {a, b, 1 + 2 * a - b, -3 + 0.5F * b});
  }
  return table;
}

TEST_CASE("a constant leaf predicts the mean of its samples") {
  const auto parameters = fit<ConstantLeaf>({{0, 0, 1, 10, 1, 1, 2, 20, 5, 5, 6, 60}});
  const auto y = predict<ConstantLeaf>(parameters, 3, 3);
  CHECK(y[0] == 3);
  CHECK(y[1] == 30);
}

TEST_CASE("a constant leaf weighs its samples") {
  const auto parameters = fit<ConstantLeaf>({{0, 0, 1, 10, 3, 1, 1, 5, 20, 1}, true});
  const auto y = predict<ConstantLeaf>(parameters, 0, 0);
  CHECK(y[0] == 2);
  CHECK(y[1] == 12.5);
}

TEST_CASE("a linear leaf recovers a plane") {
  const Table table = plane(50);
  const auto parameters = fit<LinearLeaf>(table, {.ridge = 0});
  for (std::size_t i = 0; i < 50; ++i) {
    const float* x = table.samples().input(i);
    const auto y = predict<LinearLeaf>(parameters, x[0], x[1]);
    CHECK(y[0] == doctest::Approx(static_cast<double>(x[2])).epsilon(1e-4));
    CHECK(y[1] == doctest::Approx(static_cast<double>(x[3])).epsilon(1e-4));
  }
}

TEST_CASE("a linear leaf does not leave the range of its samples unless asked") {
  const Table table = plane(50);
  float low = 1e9F;
  float high = -1e9F;
  for (std::size_t i = 0; i < 50; ++i) {
    low = std::min(low, table.samples().output(i)[0]);
    high = std::max(high, table.samples().output(i)[0]);
  }
  const auto clamped = fit<LinearLeaf>(table, {.ridge = 0});
  CHECK(predict<LinearLeaf>(clamped, 1000, 0)[0] == static_cast<double>(high));
  CHECK(predict<LinearLeaf>(clamped, -1000, 0)[0] == static_cast<double>(low));
  const auto free = fit<LinearLeaf>(table, {.ridge = 0, .clamp = false});
  CHECK(predict<LinearLeaf>(free, 1000, 0)[0] == doctest::Approx(2001).epsilon(1e-3));
}

TEST_CASE("the ridge shrinks slopes by n / (n + ridge)") {
  Table table;
  for (int i = 0; i < 20; ++i) {
    const float a = i % 2 == 0 ? -1.0F : 1.0F;
    const float b = i % 4 < 2 ? -1.0F : 1.0F;
    table.numbers.insert(table.numbers.end(), {a, b, 2 * a, b});
  }
  const auto parameters = fit<LinearLeaf>(table, {.ridge = 5});
  CHECK(static_cast<double>(parameters[0]) == doctest::Approx(2 * 20.0 / 25.0));
  CHECK(static_cast<double>(parameters[1]) == doctest::Approx(0));
  CHECK(static_cast<double>(parameters[2]) == doctest::Approx(0));
}

TEST_CASE("a linear leaf weighs its samples") {
  Table doubled;
  Table weighted{{}, true};
  Rng rng(2);
  for (int i = 0; i < 30; ++i) {
    const float a = static_cast<float>(rng.normal());
    const float b = static_cast<float>(rng.normal());
    const float c = static_cast<float>(rng.normal());
    const float d = static_cast<float>(rng.normal());
    const int copies = i % 3 + 1;
    for (int k = 0; k < copies; ++k) doubled.numbers.insert(doubled.numbers.end(), {a, b, c, d});
    weighted.numbers.insert(weighted.numbers.end(), {a, b, c, d, static_cast<float>(copies)});
  }
  const auto one = fit<LinearLeaf>(doubled, {.ridge = 0});
  const auto other = fit<LinearLeaf>(weighted, {.ridge = 0});
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK(static_cast<double>(one[i]) == doctest::Approx(static_cast<double>(other[i])).epsilon(1e-5));
  }
}

TEST_CASE("a linear leaf of samples that say nothing about slopes stays finite and inside their range") {
  const Table one_sample{{5, 6, 7, 8}};
  const Table same_inputs{{1, 1, 0, 0, 1, 1, 2, 4}};
  const Table dependent{{1, 2, 0, 0, 2, 4, 1, 1, 3, 6, 2, 2, 4, 8, 3, 3}};
  for (const Table& table : {one_sample, same_inputs, dependent}) {
    for (const double ridge : {0.0, 1.0}) {
      const auto parameters = fit<LinearLeaf>(table, {.ridge = ridge});
      for (const float p : parameters) CHECK(std::isfinite(p));
      const auto y = predict<LinearLeaf>(parameters, 100, -100);
      CHECK(y[0] >= 0);
      CHECK(y[0] <= 7);
    }
  }
  CHECK(predict<LinearLeaf>(fit<LinearLeaf>(one_sample), 0, 0)[1] == 8);
  CHECK(predict<LinearLeaf>(fit<LinearLeaf>(same_inputs), 1, 1)[1] == doctest::Approx(2));
}

TEST_CASE("a linear leaf whose slopes are no floats predicts the mean") {
  const Table steep{{0, 0, 0, 1, 1e-30F, 0, 1e20F, 3}};  // 1e50 per unit of the first input
  const auto parameters = fit<LinearLeaf>(steep);
  for (const float p : parameters) CHECK(std::isfinite(p));
  const auto y = predict<LinearLeaf>(parameters, 1, 0);
  CHECK(y[0] == doctest::Approx(5e19));
  CHECK(y[1] == 3);  // 2e30 per unit is a float
}

TEST_CASE("leaves add to what is there") {
  const std::array<float, 2> x{};
  std::array<double, 2> sum{100, 200};
  const std::vector<float> constant{1, 2};
  ConstantLeaf::add(constant.data(), x.data(), 2, 2, sum.data());
  CHECK(sum[0] == 101);
  CHECK(sum[1] == 202);
}

}  // namespace
}  // namespace surefoot

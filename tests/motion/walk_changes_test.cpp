#include "surefoot/motion/walk_changes.hpp"

#include <doctest/doctest.h>

#include <array>

#include "surefoot/core/error.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "tests/support/walks.hpp"

namespace {

const surefoot::MotionNoise noise{.constant = {0.01, 0.01, 0.04}};
using Walks = std::vector<surefoot::WalkSequence>;

Walks walks(const surefoot::Vec<12>& robot, int count, std::uint64_t seed, const surefoot::MotionNoise& how = noise) {
  return toys::walks(surefoot::FullLinearCorrection::from_parameters(robot), how, count, seed);
}

surefoot::WalkComparison compare(const Walks& before, const Walks& after, const surefoot::AnyMotionModel& model) {
  return surefoot::compare_walks({.model = model, .recorded = before}, after, {.accuracy = toys::exact});
}

/// The names of what was found, by statement.
std::vector<std::string> names(const surefoot::WalkComparison& result) {
  std::vector<std::string> found;
  for (const auto& one : result.found) {
    std::string text;
    for (const int i : one.any_of) text += (i < 0 ? "delay" : result.changes[static_cast<std::size_t>(i)].name) + ";";
    found.push_back(text);
  }
  return found;
}

const surefoot::Vec<12> usual = toys::paper_walk().parameters();

}  // namespace

TEST_CASE("the coefficient that changed is named, with its size, and no other") {
  surefoot::Vec<12> robot = usual;
  robot[11] -= 0.12;  // dt per dt
  const auto result = compare(walks(usual, 25, 1), walks(robot, 10, 2), surefoot::FullLinearCorrection());
  CHECK(names(result) == std::vector<std::string>{"dt per dt;"});
  CHECK(result.coefficients[11].probability > 0.95);
  CHECK(result.coefficients[11].difference == doctest::Approx(-0.12).epsilon(0.3));
  CHECK(result.sizes.size[0] == doctest::Approx(-0.12).epsilon(0.3));
  CHECK(result.coefficients[1].probability < 0.05);
}

TEST_CASE("nothing is found between walks of the same robot, and what would have been found is told") {
  for (const std::uint64_t seed : {3, 5, 7}) {
    const auto result = compare(walks(usual, 25, seed), walks(usual, 8, seed + 1), surefoot::FullLinearCorrection());
    CHECK(result.found.empty());
    CHECK(result.posterior.nothing > 0.5);
    CHECK(result.coefficients[11].smallest > 2 * result.coefficients[11].standard_error);
    CHECK(result.coefficients[11].smallest < 0.3);
  }
}

TEST_CASE("a response that comes two cycles later is a delay") {
  const Walks before = walks(usual, 20, 11);
  Walks after = walks(usual, 10, 12);
  for (auto& walk : after) {  // what is commanded now, the robot does two cycles later
    const Eigen::Matrix3Xd done = walk.commands;
    walk.commands.leftCols(done.cols() - 2) = done.rightCols(done.cols() - 2);
    walk.commands.rightCols(2).setZero();
  }
  const auto result = compare(before, after, surefoot::FullLinearCorrection());
  CHECK(names(result) == std::vector<std::string>{"delay;"});
  CHECK(result.likeliest.delay == 2);
}

TEST_CASE("noise that grew is found, and no coefficient with it") {
  const surefoot::MotionNoise more{.constant = {0.01, 0.02, 0.04}};
  const auto result = compare(walks(usual, 20, 21), walks(usual, 10, 22, more), surefoot::FullLinearCorrection());
  CHECK(names(result) == std::vector<std::string>{"noise sideways;"});
}

TEST_CASE("a calibration takes the place of the old sequences") {
  surefoot::Vec<12> robot = usual;
  robot[4] += 0.01;  // dy offset
  const Walks before = walks(usual, 25, 31), after = walks(robot, 10, 32);
  surefoot::CalibrationOptions options;
  options.model.accuracy = toys::exact;
  const auto fit = surefoot::calibrate(before, options, surefoot::AnyMotionModel(surefoot::FullLinearCorrection()));
  const surefoot::FormerWalk former{
      .model = fit.model, .covariance = fit.covariance, .noise = fit.noise, .sequences = 25, .readings = 1875};
  const auto result = surefoot::compare_walks(former, after, {.accuracy = toys::exact});
  CHECK(names(result) == std::vector<std::string>{"dy offset;"});
}

TEST_CASE("falls count as evidence") {
  const Walks before = walks(usual, 20, 41), after = walks(usual, 12, 42);
  const auto result = surefoot::compare_walks({.model = surefoot::FullLinearCorrection(), .recorded = before}, after,
                                              {.accuracy = toys::exact}, surefoot::WalkFalls{{0, 20}, {12, 24}});
  CHECK(names(result) == std::vector<std::string>{"falls;"});
  REQUIRE(result.falls);
  CHECK(result.falls->p_value < 0.01);
}

TEST_CASE("wrong options of a comparison of walks are refused by name") {
  CHECK_THROWS_AS(check(surefoot::WalkChangeOptions{.prior = 0}), surefoot::MotionError);
  CHECK_THROWS_AS(check(surefoot::WalkChangeOptions{.certainty = 1}), surefoot::MotionError);
}

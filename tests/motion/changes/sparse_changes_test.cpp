#include "surefoot/motion/changes/sparse_changes.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "surefoot/core/error.hpp"

using surefoot::DifferenceEvidence;
using surefoot::WalkChange;

namespace {

std::vector<WalkChange> three_changes() {
  std::vector<WalkChange> changes;
  for (Eigen::Index i = 0; i < 3; ++i) {
    changes.push_back({.name = "c" + std::to_string(i), .direction = Eigen::VectorXd::Unit(3, i), .deviation = 1});
  }
  return changes;
}

/// Known with a standard deviation of 0.1.
DifferenceEvidence evidence_of(const Eigen::Vector3d& difference, double freedoms = 1e6) {
  return {.difference = difference, .information = 100 * Eigen::Matrix3d::Identity(), .freedoms = freedoms};
}

surefoot::ChangePosterior posterior(const DifferenceEvidence& evidence) {
  const auto changes = three_changes();
  return surefoot::posterior_of_changes(std::span(&evidence, 1), changes);
}

}  // namespace

TEST_CASE("one large difference is the change of that coefficient alone") {
  const auto result = posterior(evidence_of({0, 1, 0}));
  CHECK(result.inclusion[1] > 0.999);
  CHECK(result.inclusion[0] < 0.2);
  CHECK(result.nothing < 1e-6);
  CHECK(result.sets.front().members == std::vector<int>{1});
  const auto changes = three_changes();
  const auto sizes = surefoot::change_sizes(evidence_of({0, 1, 0}), changes, std::array{1});
  CHECK(sizes.size[0] == doctest::Approx(1 / 1.01));
}

TEST_CASE("the posterior of no change is that of Bayes' rule") {
  // Independent coefficients: by hand, with sets of 1, 2 and 3 changes of prior 1/4, 1/8, 1/16 shared by 3, 3 and 1.
  const double factor = 1 / std::sqrt(101.0);  // of each null coefficient, 100 being information times variance
  const double none = 0.5, one = 0.25 * factor, two = 0.125 * factor * factor, three = std::pow(factor, 3) / 16;
  CHECK(posterior(evidence_of({0, 0, 0})).nothing == doctest::Approx(none / (none + one + two + three)).epsilon(1e-6));
}

TEST_CASE("changes that the data cannot tell apart share the probability") {
  auto changes = three_changes();
  changes[2].direction = changes[1].direction;
  const auto evidence = evidence_of({0, 1, 0});
  const auto result = surefoot::posterior_of_changes(std::span(&evidence, 1), changes);
  CHECK(result.inclusion[1] < 0.7);
  CHECK(result.inclusion[1] == doctest::Approx(result.inclusion[2]));
  CHECK(result.any_of(std::array{1, 2}) > 0.999);
}

TEST_CASE("few degrees of freedom ask for more") {
  const auto sure = posterior(evidence_of({0, 0.45, 0}, 1e6)), unsure = posterior(evidence_of({0, 0.45, 0}, 4));
  CHECK(sure.nothing < unsure.nothing);
}

TEST_CASE("a change as large as the smallest detectable one is found, one of a third of it is not") {
  const auto changes = three_changes();
  const double smallest = surefoot::smallest_detectable(evidence_of({0, 0, 0}, 40), changes, 1, 0.95);
  CHECK(posterior(evidence_of({0, smallest, 0}, 40)).nothing < 0.05);
  CHECK(posterior(evidence_of({0, smallest / 3, 0}, 40)).nothing > 0.05);
}

TEST_CASE("a delay that explains the data better is found") {
  std::array<DifferenceEvidence, 2> by_delay{evidence_of({1, 1, 1}), evidence_of({0, 0, 0})};
  by_delay[1].delay = 1;
  by_delay[0].log_evidence = -150;  // half the squared difference
  const auto changes = three_changes();
  const auto result = surefoot::posterior_of_changes(by_delay, changes);
  CHECK(result.any_of(std::array{-1}) > 0.99);
  CHECK(result.sets.front().delay == 1);
}

TEST_CASE("wrong options of sparse changes are refused by name") {
  CHECK_THROWS_AS(check(surefoot::SparseChangeOptions{.nothing = 1}), surefoot::MotionError);
  CHECK_THROWS_AS(check(surefoot::SparseChangeOptions{.largest_set = 0}), surefoot::MotionError);
}

// Which terms a search of a robot adds.
#include "apps/diagnose/robot/choose_terms.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/core/rng.hpp"

using namespace diagnose_robot;

namespace {

constexpr Eigen::Index rows = 400;
constexpr int precise_terms = 10;

// Two joints of one block each. Errors of the first are small and all different, and each of its terms takes a bit off
// them; those of the second are large and slow, so that few of them count, and the last term explains them.
LinearModel precise_and_slow() {
  surefoot::Rng rng(5);
  LinearModel model;
  const Eigen::Index terms = precise_terms + 1;
  model.sums.assign(2, std::vector<Sums>(1));
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(rows, terms), y = x;
  Eigen::VectorXd precise(rows), slow(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    for (Eigen::Index t = 0; t < precise_terms; ++t) x(k, t) = rng.uniform() - 0.5;
    precise[k] = 1e-4 * (rng.uniform() - 0.5) - 1e-4 * x.row(k).sum();
    y(k, precise_terms) = -std::sin(0.02 * static_cast<double>(k));
    slow[k] = 1e-2 * (0.3 * (rng.uniform() - 0.5) - y(k, precise_terms));
  }
  model.sums[0][0] = {x.transpose() * x, x.transpose() * precise, precise.squaredNorm(), rows};
  model.sums[1][0] = {y.transpose() * y, y.transpose() * slow, slow.squaredNorm(), rows};
  // Held-out blocks need more than one.
  for (auto& blocks : model.sums) blocks.push_back(blocks.front());
  model.independent = Eigen::VectorXd{{2 * rows, 12}};
  model.pool = {0, 1};
  model.theta = Eigen::VectorXd::Zero(terms);
  model.low = Eigen::VectorXd::Constant(terms, -1);
  model.high = Eigen::VectorXd::Constant(terms, 1);
  model.prior = Eigen::VectorXd::Constant(terms, 0.5);
  model.smallest = Eigen::VectorXd::Zero(terms);
  model.cost = Eigen::VectorXd::Constant(terms, std::log(static_cast<double>(rows)));
  model.acts_on.assign(static_cast<std::size_t>(terms), {0});
  model.acts_on.back() = {1};
  model.least_taken = Eigen::VectorXd::Constant(terms, 1e-3);  // two simulations of one model differ by more
  add_up(model);
  return model;
}

}  // namespace

TEST_CASE("terms below what simulations of one model differ by are not in the way of one that is less probable") {
  const LinearModel model = precise_and_slow();
  const auto last = static_cast<std::size_t>(precise_terms);
  TermSet all(last + 1, 1), wanted(last + 1, 0), probable = wanted;
  wanted[last] = 1;
  probable[0] = 1;
  REQUIRE(fit_linear(model, probable).criterion < fit_linear(model, wanted).criterion);
  REQUIRE(worth_of(model, probable, 0) < 1);
  CHECK(choose_terms(model, TermSet(last + 1, 0), all) == wanted);
}

TEST_CASE("a term that explains a joint does not give way to a more probable one that simulations of one model undo") {
  const LinearModel model = precise_and_slow();
  const auto last = static_cast<std::size_t>(precise_terms);
  TermSet wanted(last + 1, 0);
  wanted[last] = 1;
  CHECK(choose_terms(model, wanted, TermSet(last + 1, 1)) == wanted);
}

TEST_CASE("terms that explain other errors are no tie, however much they explain") {
  LinearModel model = precise_and_slow();
  const auto last = static_cast<std::size_t>(precise_terms);
  TermSet set(last + 1, 0);
  set[0] = 1;
  CHECK_FALSE(explain_the_same(model, set, {0, precise_terms, 0}));
  // Two columns that are the same.
  for (Sums& sums : model.sums[0]) {
    sums.gram.row(1) = sums.gram.row(0).eval();
    sums.gram.col(1) = sums.gram.col(0).eval();
    sums.slope[1] = sums.slope[0];
  }
  add_up(model);
  CHECK(explain_the_same(model, set, {0, 1, 0}));
}

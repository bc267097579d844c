#include "apps/diagnose/robot/linear_model.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "apps/diagnose/robot/choose_terms.hpp"
#include "apps/diagnose/robot/diagnose_robot.hpp"
#include "apps/diagnose/robot/robot_diagnosis.hpp"
#include "apps/diagnose/robot/swapped_joints.hpp"
#include "apps/diagnose/robot/swapped_torques.hpp"
#include "surefoot/core/rng.hpp"

using namespace diagnose_robot;

namespace {

double normal(surefoot::Rng& rng) {
  double sum = 0;
  for (int i = 0; i < 12; ++i) sum += rng.uniform();
  return sum - 6;
}

// One joint, four blocks: errors `r`, of which terms take away multiples of the columns of `x`.
LinearModel model_of(const Eigen::MatrixXd& x, const Eigen::VectorXd& r) {
  constexpr Eigen::Index blocks = 4;
  const Eigen::Index terms = x.cols(), rows = x.rows() / blocks;
  LinearModel model;
  model.sums.resize(1);
  for (Eigen::Index b = 0; b < blocks; ++b) {
    const auto part = x.middleRows(b * rows, rows);
    const auto errors = r.segment(b * rows, rows);
    model.sums[0].push_back(
        {part.transpose() * part, part.transpose() * errors, errors.squaredNorm(), static_cast<double>(rows)});
  }
  model.independent = Eigen::VectorXd::Constant(1, static_cast<double>(x.rows()));
  model.pool = {0};
  model.theta = Eigen::VectorXd::Zero(terms);
  model.low = Eigen::VectorXd::Zero(terms);
  model.high = Eigen::VectorXd::Constant(terms, 10);
  model.prior = Eigen::VectorXd::Constant(terms, 5);
  model.smallest = Eigen::VectorXd::Zero(terms);
  model.cost = Eigen::VectorXd::Constant(
      terms, std::log(static_cast<double>(x.rows())) + 2 * std::log(static_cast<double>(terms)));
  model.acts_on.assign(static_cast<std::size_t>(terms), {0});
  add_up(model);
  return model;
}

// White columns; the errors are `sizes` times the columns and noise of 1.
LinearModel made_up(const Eigen::VectorXd& sizes, std::uint64_t seed) {
  surefoot::Rng rng(seed);
  constexpr Eigen::Index rows = 400;
  Eigen::MatrixXd x(rows, sizes.size());
  Eigen::VectorXd r(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    for (Eigen::Index t = 0; t < sizes.size(); ++t) x(k, t) = -normal(rng);
    r[k] = normal(rng) - x.row(k).dot(sizes);
  }
  return model_of(x, r);
}

}  // namespace

TEST_CASE("a quadratic is minimised within its bounds") {
  surefoot::Rng rng(3);
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::MatrixXd root(4, 4);
    for (double& value : root.reshaped()) value = normal(rng);
    const Eigen::MatrixXd q = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(4, 4);
    Eigen::VectorXd c(4);
    for (double& value : c) value = 3 * normal(rng);
    const Eigen::VectorXd low = Eigen::VectorXd::Constant(4, -0.5), high = Eigen::VectorXd::Constant(4, 0.7);
    const Eigen::VectorXd x = bounded_minimum(q, c, low, high), gradient = c + q * x;
    for (Eigen::Index i = 0; i < 4; ++i) {
      CHECK(x[i] >= low[i]);
      CHECK(x[i] <= high[i]);
      if (x[i] > low[i] && x[i] < high[i]) CHECK(std::abs(gradient[i]) < 1e-8);
      if (x[i] == low[i]) CHECK(gradient[i] > -1e-8);
      if (x[i] == high[i]) CHECK(gradient[i] < 1e-8);
    }
  }
}

TEST_CASE("the terms that made the errors are chosen, with their sizes, and no others") {
  const Eigen::VectorXd sizes{{0, 0.8, 0, 0, 0.5, 0}};
  const LinearModel model = made_up(sizes, 4);
  const TermSet set = choose_terms(model, TermSet(6, 0), TermSet(6, 1));
  CHECK(set == TermSet{0, 1, 0, 0, 1, 0});
  const Eigen::VectorXd found = fit_linear(model, set).change, error = standard_errors(model, set);
  CHECK(std::abs(found[1] - 0.8) < 4 * error[1]);
  CHECK(error[1] == doctest::Approx(0.05).epsilon(0.2));
  CHECK(held_out_gain(model, set, 1).share > 0.1);
  CHECK(evidence_of_terms(model, set)[4] > 20);
}

TEST_CASE("two terms take the place of one that stands for a bit of both") {
  surefoot::Rng rng(13);
  constexpr Eigen::Index rows = 400;
  constexpr double size = 0.68;
  Eigen::MatrixXd x(rows, 3);
  Eigen::VectorXd r(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double v = normal(rng), w = normal(rng);
    x.row(k) << -w, w - 0.3 * v, -v - 0.35 * normal(rng);  // neither of the first two does without the other
    r[k] = normal(rng) + size * v;
  }
  const LinearModel model = model_of(x, r);
  CHECK(choose_terms(model, TermSet{0, 0, 1}, TermSet(3, 1)) == TermSet{1, 1, 0});
  CHECK(fit_linear(model, TermSet{1, 1, 0}).change[1] == doctest::Approx(size / 0.3).epsilon(0.15));
}

TEST_CASE("an effect is worth little beside errors that nothing explains, and not beside noise as large") {
  const Eigen::VectorXd sizes{{0.3}};
  const LinearModel model = made_up(sizes, 14);
  const TermSet set{1};
  CHECK(worth_of(model, set, 0) > 1);
  CHECK(worth_beside_unexplained(model, set, 0, Eigen::VectorXd::Constant(1, 0.1)) < 1);
  CHECK(worth_beside_unexplained(model, set, 0, Eigen::VectorXd::Constant(1, 1.0)) > 1);
}

TEST_CASE("noise alone gives no term") {
  int chosen = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    for (const char in : choose_terms(made_up(Eigen::VectorXd::Zero(10), seed), TermSet(10, 0), TermSet(10, 1)))
      chosen += in;
  }
  CHECK(chosen == 0);
}

TEST_CASE("a term for which one block alone speaks stays uncertain, and one for which all speak does not") {
  LinearModel model = made_up(Eigen::VectorXd::Zero(1), 8);
  const auto speaks = [&](std::size_t block, double gain) {  // errors that the term takes away, of `gain` units
    Sums& sums = model.sums[0][block];
    sums.slope[0] = -std::sqrt(gain * sums.gram(0, 0));
    sums.square = sums.rows + gain;
  };
  const TermSet with{1}, without{0};
  for (std::size_t b = 0; b < 4; ++b) speaks(b, 9);
  add_up(model);
  const double all = evidence_between(model, with, without);
  for (std::size_t b = 0; b < 4; ++b) speaks(b, b == 0 ? 36 : 0);
  add_up(model);
  const double one = evidence_between(model, with, without);
  CHECK(all > 5.99);
  CHECK(one < all - 3);
}

TEST_CASE("a term that refines another is not chosen without it") {
  LinearModel model = made_up(Eigen::VectorXd{{0.0, 0.6}}, 9);
  model.refines = {{}, {0}};
  CHECK(choose_terms(model, TermSet(2, 0), TermSet(2, 1)) == TermSet{0, 0});
  model = made_up(Eigen::VectorXd{{0.7, 0.6}}, 9);
  model.refines = {{}, {0}};
  CHECK(choose_terms(model, TermSet(2, 0), TermSet(2, 1)) == TermSet{1, 1});
}

TEST_CASE("a size far beyond its prior is rare, but costs no more than evidence can pay") {
  const LinearModel model = made_up(Eigen::VectorXd::Zero(1), 10);
  CHECK(prior_cost(model, 0, 0) == 0);
  CHECK(prior_cost(model, 0, 5) > prior_cost(model, 0, 1));
  CHECK(prior_cost(model, 0, 10 * 5) < 10);
}

TEST_CASE("a large effect is fitted whole, though what it has not yet explained looks like noise") {
  LinearModel model = made_up(Eigen::VectorXd{{9.0}}, 12);
  model.independent.setConstant(18);  // few, so that the prior is the stronger at first
  model.prior.setConstant(2);
  const LinearFit fit = fit_linear(model, {1});
  CHECK(fit.change[0] == doctest::Approx(9).epsilon(0.02));
}

TEST_CASE("a term that is not needed any more is taken away, and its size goes to zero") {
  LinearModel model = made_up(Eigen::VectorXd::Zero(3), 5);
  const TermSet set = choose_terms(model, TermSet{1, 0, 0}, TermSet(3, 1));
  CHECK(set == TermSet{0, 0, 0});
  model.theta[0] = 0.3;
  CHECK(fit_linear(model, set).change[0] == -0.3);
}

TEST_CASE("rows that repeat what the ones before said count less") {
  surefoot::Rng rng(6);
  Eigen::VectorXd white(4000), slow(4000);
  for (Eigen::Index k = 0; k < 4000; ++k) {
    white[k] = normal(rng);
    slow[k] = k == 0 ? white[0] : 0.9 * slow[k - 1] + white[k];
  }
  CHECK(independent_errors(white) == doctest::Approx(4000).epsilon(0.15));
  CHECK(independent_errors(slow) == doctest::Approx(4000 * 0.1 / 1.9).epsilon(0.4));
  Eigen::VectorXd wave(4000);  // a damped oscillation that noise keeps going
  for (Eigen::Index k = 0; k < 4000; ++k)
    wave[k] = k < 2 ? 0 : 1.9 * std::cos(0.3) * wave[k - 1] - 0.9025 * wave[k - 2] + white[k];
  CHECK(independent_errors(wave) < 1000);
}

TEST_CASE("columns that were swapped are told by what each is told to do") {
  Eigen::MatrixXd unexplained = Eigen::MatrixXd::Constant(3, 3, 0.9);
  unexplained(0, 0) = 0.02;
  unexplained(1, 2) = unexplained(2, 1) = 0.03;
  CHECK(swapped_pairs(unexplained) == std::vector<std::pair<int, int>>{{1, 2}});
  unexplained.setConstant(0.05);  // all move alike: no one can tell
  CHECK(swapped_pairs(unexplained).empty());
}

TEST_CASE("angles that were swapped are told by the likelihood of all torques") {
  const std::vector<TorqueMisfit> as_is{{0.3, 40}, {0.2, 40}, {0.02, 40}};
  const SwappedAngles found = compare_swapped(0, 1, as_is, {{0.02, 30}, {0.03, 30}, {0.02, 40}});
  CHECK(found.each_alone);
  CHECK(found.evidence == doctest::Approx(30 * std::log(15) + 30 * std::log(0.2 / 0.03)));
  const SwappedAngles other = compare_swapped(1, 2, as_is, {{0.3, 40}, {0.05, 40}, {0.1, 40}});
  CHECK_FALSE(other.each_alone);  // the torque of joint 2 speaks against it
  CHECK(likely_swaps({other, found}) == std::vector<std::pair<int, int>>{{0, 1}});
  const SwappedAngles weak = compare_swapped(0, 1, as_is, {{0.25, 10}, {0.18, 10}, {0.02, 40}});
  CHECK(weak.each_alone);
  CHECK(likely_swaps({weak}).empty());  // odds of less than 20
  CHECK(likely_swaps({found, {1, 2, found.evidence + 1, true}}) == std::vector<std::pair<int, int>>{{1, 2}});
}

TEST_CASE("the verdict follows the noise floor, then what was found") {
  using surefoot::Verdict;
  CHECK(verdict_of(2, 0, 1.2, 1, true) == Verdict::missing_physics);
  CHECK(verdict_of(2, 0, 1.6, 1, true) == Verdict::unexplained);
  CHECK(verdict_of(0, 1, 1, 1, true) == Verdict::parameters_only);
  CHECK(verdict_of(0, 0, 1, 1, true) == Verdict::adequate);
  CHECK(verdict_of(0, 0, 1, 1, false) == Verdict::unfinished);
}

TEST_CASE("the noise of an encoder is seen through its motion") {
  surefoot::Rng rng(7);
  Eigen::VectorXd readings(2000);
  for (Eigen::Index k = 0; k < 2000; ++k) readings[k] = std::sin(0.03 * static_cast<double>(k)) + 1e-3 * normal(rng);
  CHECK(noise_of(readings) == doctest::Approx(1e-3).epsilon(0.1));
}

#include "surefoot/optimize/cma_es.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/optimize/cma_es_serialize.hpp"
#include "tests/optimize/test_functions.hpp"

namespace surefoot {
namespace {

using Eigen::VectorXd;

double noisy_sphere(const VectorXd& x, Rng& rng) { return toy::sphere(x) + rng.normal(); }

struct Named {
  const char* name;
  double (*function)(const VectorXd&);
};

TEST_CASE("the minimum is found from many starts in few and in many dimensions") {
  for (const Named& f : {Named{"sphere", toy::sphere}, Named{"ellipsoid", toy::ellipsoid}}) {
    for (const Eigen::Index n : {2, 6, 12}) {
      for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const auto result = cma_es(f.function, toy::random_start(n, 3, seed), 1.0, {.target = 1e-9}, Serial{}, seed);
        INFO(f.name << " in " << n << " dimensions, seed " << seed);
        CHECK(result.reason == StopReason::target_reached);
        CHECK(result.best.cwiseAbs().maxCoeff() < 1e-4);
        CHECK(result.best_value == f.function(result.best));
      }
    }
  }
  CHECK(
      cma_es(toy::ellipsoid, toy::random_start(40, 1, 1), 0.5, {.target = 1e-9, .max_evaluations = 60'000}, Serial{}, 1)
          .reason == StopReason::target_reached);
}

TEST_CASE("Rosenbrock's valley is followed to its end") {
  // In 2 dimensions there is one minimum; in 6 a descent may end in the other one, hence the restarts.
  CHECK(cma_es(toy::rosenbrock, VectorXd{{-1.2, 1}}, 0.5, {.target = 1e-9}, Serial{}, 1).reason ==
        StopReason::target_reached);
  const auto result =
      cma_es(toy::rosenbrock, VectorXd::Zero(6), 0.5, {.restarts = Restarts::ipop, .target = 1e-9}, Serial{}, 1);
  CHECK(result.reason == StopReason::target_reached);
  CHECK(result.best.isApprox(VectorXd::Ones(6), 1e-3));
}

TEST_CASE("one dimension and a dimension without effect are no problem") {
  const auto line = [](const VectorXd& x) { return std::abs(x[0] - 3); };
  CHECK(cma_es(line, VectorXd::Zero(1), 1, {.target = 1e-9}, Serial{}, 1).reason == StopReason::target_reached);
  const auto flat_direction = [](const VectorXd& x) { return x[0] * x[0]; };
  CHECK(cma_es(flat_direction, VectorXd::Ones(3), 1, {.target = 1e-9}, Serial{}, 1).reason ==
        StopReason::target_reached);
}

TEST_CASE("the best point of a box is found on a face, on an edge, in a corner and inside") {
  const Box<Eigen::Dynamic> box{VectorXd{{-1, 0, 100}}, VectorXd{{1, 5, 300}}};
  const VectorXd widths = box.width();
  for (const VectorXd& target :
       {VectorXd{{0.3, -2, 150}}, VectorXd{{3, 7, 250}}, VectorXd{{-4, 9, 20}}, VectorXd{{0.999, 4.99, 299.9}}}) {
    const auto distance = [&](const VectorXd& x) {
      CHECK(box.contains(x));
      return (x - target).cwiseQuotient(widths).squaredNorm();
    };
    const auto result = cma_es(distance, box.center(), box, {}, Serial{}, 1);
    CHECK((result.best - box.clamp(target)).cwiseQuotient(widths).norm() < 1e-5);
    CHECK(result.evaluations < 5000);
  }
}

TEST_CASE("a fixed dimension of the box keeps its value") {
  const Box<Eigen::Dynamic> box{VectorXd{{-1, 0.5}}, VectorXd{{1, 0.5}}};
  const auto result = cma_es(toy::sphere, VectorXd{{0.9, 0.5}}, box, {}, Serial{}, 1);
  CHECK(result.best[1] == 0.5);
  CHECK(std::abs(result.best[0]) < 1e-5);
}

TEST_CASE("BIPOP finds the best of a thousand local minima") {
  const auto box = Box<Eigen::Dynamic>::symmetric(VectorXd::Constant(4, 5.12));
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto result = cma_es(toy::rastrigin, toy::random_start(4, 5, seed), box,
                               {.restarts = Restarts::bipop, .target = 1e-9}, Serial{}, seed);
    CHECK(result.reason == StopReason::target_reached);
    std::uint64_t evaluations = 0;
    for (const CmaEsDescent& descent : result.descents) evaluations += descent.evaluations;
    CHECK(evaluations == result.evaluations);
    CHECK(result.descents.back().best == result.best);
  }
}

TEST_CASE("restarts end when they are used up, with the reason of the last descent") {
  const auto result = cma_es(toy::rastrigin, VectorXd::Constant(5, 3.0), 0.1,
                             {.restarts = Restarts::ipop, .max_restarts = 2}, Serial{}, 1);
  REQUIRE(result.descents.size() == 3);
  CHECK(result.descents[2].population == 4 * result.descents[0].population);
  CHECK(result.reason == result.descents[2].reason);
}

TEST_CASE("noise that all candidates of a generation share does not disturb the search") {
  const auto shared = [](const VectorXd& x, Rng& rng) { return toy::sphere(x) + 1000 * rng.normal(); };
  const auto result = cma_es(shared, VectorXd::Ones(4), 1, {.max_evaluations = 3000}, Serial{}, 1);
  CHECK(toy::sphere(result.search.state.mean) < 1e-9);
}

TEST_CASE("averaging where noise confuses the ranks gets closer to the minimum for the same evaluations") {
  const auto error = [](int max_evaluations, std::uint64_t seed) {
    const CmaEsOptions options{.max_evaluations = 20'000,
                               .noise = {.max_evaluations = max_evaluations, .common_random_numbers = false}};
    const auto result = cma_es(noisy_sphere, VectorXd::Constant(4, 2.0), 1, options, Serial{}, seed);
    return toy::sphere(result.descents.back().mean);
  };
  double plain = 0, averaged = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    plain += error(1, seed) / 5;
    averaged += error(1000, seed) / 5;
  }
  CHECK(averaged < 0.1);  // the noise has a standard deviation of 1
  CHECK(averaged < 0.5 * plain);
}

TEST_CASE("values that are not finite are avoided, and if there are no others the message says so") {
  const auto half_defined = [](const VectorXd& x) {
    return x[0] < 0 ? std::numeric_limits<double>::quiet_NaN() : toy::sphere(x);
  };
  const auto result = cma_es(half_defined, VectorXd::Ones(3), 0.5, {.max_evaluations = 2000}, Serial{}, 1);
  CHECK(result.best_value < 1e-6);
  CHECK(result.best[0] >= 0);
  const auto undefined = [](const VectorXd&) { return std::numeric_limits<double>::quiet_NaN(); };
  CHECK_THROWS_WITH_AS(cma_es(undefined, VectorXd::Ones(3), 0.5, {}, Serial{}, 1),
                       doctest::Contains("the objective is not finite at any of the 7 candidates of generation 0"),
                       OptimizeError);
}

// Everything at once: a box, restarts, noise and its handling.
CmaEsOptions rich_options(std::uint64_t max_evaluations) {
  return {.restarts = Restarts::bipop,
          .max_evaluations = max_evaluations,
          .tolerances = {.x = 0.1},
          .noise = {.max_evaluations = 8, .disorder = 0.3, .common_random_numbers = false}};
}
const Box<Eigen::Dynamic> rich_box{VectorXd{{-3, -1, 0, 2}}, VectorXd{{3, 5, 4, 2}}};
const VectorXd rich_start{{1, 1, 1, 2}};
double rich_objective(const VectorXd& x, Rng& rng) { return toy::rastrigin(x) + 0.3 * rng.normal(); }

TEST_CASE("the result has the same bits on any number of threads") {
  const auto run = [](const auto& executor, std::uint64_t seed) {
    return save(cma_es(rich_objective, rich_start, rich_box, rich_options(10'000), executor, seed).search);
  };
  const Bytes serial = run(Serial{}, 5);
  CHECK(run(Threads(2), 5) == serial);
  CHECK(run(Threads(3), 5) == serial);
  CHECK(run(Serial{}, 6) != serial);
}

TEST_CASE("a search that is interrupted, saved, loaded and resumed has the bits of one that was not") {
  const CmaEsResult whole = cma_es(rich_objective, rich_start, rich_box, rich_options(20'000), Serial{}, 5);
  REQUIRE(whole.descents.size() > 3);
  CmaEsSearch search = cma_es_search(rich_start, 0.3, rich_box, rich_options(20'000), 5);
  CmaEsResult parts;
  for (std::uint64_t budget = 100; budget < 20'000; budget += 611) {
    parts = cma_es(rich_objective, search, rich_options(budget), Serial{});
    search = load_cma_es_search(save(parts.search), "test");
  }
  parts = cma_es(rich_objective, search, rich_options(20'000), Serial{});
  CHECK(save(parts.search) == save(whole.search));
  CHECK(parts.best == whole.best);
  CHECK(parts.descents.size() == whole.descents.size());
}

TEST_CASE("on_progress sees every generation in a state that can be resumed") {
  std::vector<CmaEsSearch> seen;
  const CmaEsOptions observed{.target = 1e-6,
                              .on_progress = [&](const CmaEsSearch& search) { seen.push_back(search); }};
  const auto result = cma_es(toy::ellipsoid, VectorXd::Ones(4), 0.5, observed, Serial{}, 1);
  REQUIRE(seen.size() == result.descents.back().generations);
  const auto resumed = cma_es(toy::ellipsoid, seen[seen.size() / 2], {.target = 1e-6}, Serial{});
  CHECK(save(resumed.search) == save(result.search));
}

TEST_CASE("options that make no sense are refused by name") {
  const auto message = [](const CmaEsOptions& options) -> std::string {
    try {
      cma_es(toy::sphere, VectorXd::Ones(3), 0.5, options, Serial{}, 1);
    } catch (const OptimizeError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(message({.box_sigma = 0}).find("box_sigma") != std::string::npos);
  CHECK(message({.population = 3}).find("population") != std::string::npos);
  CHECK(message({.population = 2'000'000}).find("population") != std::string::npos);
  CHECK(message({.max_restarts = -1}).find("max_restarts") != std::string::npos);
  CHECK(message({.population_growth = 0.5}).find("population_growth") != std::string::npos);
  CHECK(message({.target = std::nan("")}).find("target") != std::string::npos);
  CHECK(message({.max_seconds = -1}).find("max_seconds") != std::string::npos);
  CHECK(message({.noise = {.evaluations = 0}}).find("noise.evaluations") != std::string::npos);
  CHECK(message({.noise = {.growth = 0.5}}).find("noise.growth") != std::string::npos);
  const auto box = Box<Eigen::Dynamic>::symmetric(VectorXd::Ones(3));
  CHECK_THROWS_WITH_AS(cma_es(toy::sphere, VectorXd::Constant(3, 2.0), box, {}, Serial{}, 1),
                       doctest::Contains("start must lie in the box"), OptimizeError);
}

TEST_CASE("an exception of the objective reaches the caller") {
  struct Broken {};
  const auto broken = [](const VectorXd&) -> double { throw Broken{}; };
  CHECK_THROWS_AS(cma_es(broken, VectorXd::Ones(3), 0.5, {}, Threads(2), 1), Broken);
}

}  // namespace
}  // namespace surefoot

// CMA-ES against pagmo's, from the same starts with the same first distribution and population: how many evaluations
// to reach 1e-9, and how much CPU time per evaluation (that of the objective, about 0.01 us, included). Each row is 15
// seeds. Both restart with a doubled population where a descent ends elsewhere: pagmo by the loop below, as it has no
// restarts of its own. Counters: median of the evaluations, seeds that reached the target, CPU seconds per evaluation.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/optimize/cma_es.hpp"
#include "surefoot/optimize/least_squares.hpp"
#include "tests/optimize/test_functions.hpp"

#ifdef SUREFOOT_HAS_PAGMO
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#endif

namespace {

using Eigen::VectorXd;

constexpr double target = 1e-9;
constexpr std::uint64_t budget = 1'000'000;  // evaluations of one seed
constexpr std::uint64_t seeds = 15;

struct Case {
  const char* name;
  double (*function)(const VectorXd&);
  double width;  // starts are uniform in [-width, width]
  double sigma;
};

// The test function with its powers worked out once.
double ellipsoid(const VectorXd& x) {
  thread_local VectorXd curvature;
  if (curvature.size() != x.size()) {
    curvature.resize(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      curvature[i] = std::pow(1e6, static_cast<double>(i) / static_cast<double>(x.size() - 1));
    }
  }
  return (curvature.array() * x.array().square()).sum();
}

constexpr Case sphere{"sphere", surefoot::toy::sphere, 1, 0.5};
constexpr Case elli{"ellipsoid", ellipsoid, 1, 0.5};
constexpr Case rosenbrock{"rosenbrock", surefoot::toy::rosenbrock, 1, 0.5};
constexpr Case rastrigin{"rastrigin", surefoot::toy::rastrigin, 5, 2};

struct Outcome {
  std::uint64_t evaluations = 0;
  bool solved = false;
};

template <class Solver>
void descend(benchmark::State& state, const Case& problem, const Solver& solve) {
  std::vector<std::uint64_t> evaluations;
  double solved = 0, total = 0;
  for (auto _ : state) {
    evaluations.clear();
    solved = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const Outcome outcome = solve(problem, surefoot::toy::random_start(state.range(0), problem.width, seed), seed);
      evaluations.push_back(outcome.evaluations);
      solved += outcome.solved;
      total += static_cast<double>(outcome.evaluations);
    }
  }
  std::ranges::sort(evaluations);
  state.counters["evaluations"] = static_cast<double>(evaluations[seeds / 2]);
  state.counters["solved"] = solved;
  state.counters["per_evaluation"] =
      benchmark::Counter(total, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

Outcome surefoot_with(surefoot::Restarts restarts, const Case& problem, const VectorXd& start, std::uint64_t seed) {
  const auto result =
      surefoot::cma_es(problem.function, start, problem.sigma,
                       {.restarts = restarts, .target = target, .max_evaluations = budget}, surefoot::Serial{}, seed);
  return {result.evaluations, result.reason == surefoot::StopReason::target_reached};
}

void surefoot_ipop(benchmark::State& state, const Case& problem) {
  descend(state, problem, [](const Case& p, const VectorXd& start, std::uint64_t seed) {
    return surefoot_with(surefoot::Restarts::ipop, p, start, seed);
  });
}

void surefoot_bipop(benchmark::State& state, const Case& problem) {
  descend(state, problem, [](const Case& p, const VectorXd& start, std::uint64_t seed) {
    return surefoot_with(surefoot::Restarts::bipop, p, start, seed);
  });
}

#ifdef SUREFOOT_HAS_PAGMO
struct TargetReached {};

// pagmo takes the first standard deviation in widths of the bounds, which it otherwise ignores: they have width 1.
struct PagmoProblem {
  double (*function)(const VectorXd&) = nullptr;
  std::size_t dimension = 0;
  std::uint64_t* evaluations = nullptr;
  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    ++*evaluations;
    thread_local VectorXd point;
    point = Eigen::Map<const VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    const double value = function(point);
    if (value <= target) throw TargetReached{};
    return {value};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(dimension, -0.5), pagmo::vector_double(dimension, 0.5)};
  }
};

Outcome pagmo_ipop(const Case& problem, const VectorXd& start, std::uint64_t seed) {
  Outcome outcome;
  const auto n = static_cast<std::size_t>(start.size());
  auto population = static_cast<pagmo::population::size_type>(surefoot::default_population(start.size()));
  surefoot::Rng rng(seed, 0x706167);
  VectorXd from = start;
  for (unsigned restart = 0; outcome.evaluations < budget; ++restart, population *= 2) {
    pagmo::population candidates(pagmo::problem(PagmoProblem{problem.function, n, &outcome.evaluations}), 0, 1);
    // It begins at the best of these; two that differ, lest it takes the population for converged.
    const pagmo::vector_double mean(from.data(), from.data() + n);
    pagmo::vector_double worse(n, 1e3);
    for (pagmo::population::size_type i = 0; i < population; ++i) candidates.push_back(i == 0 ? worse : mean);
    const auto generations = static_cast<unsigned>((budget - outcome.evaluations) / population + 1);
    const pagmo::algorithm algorithm(pagmo::cmaes(generations, -1, -1, -1, -1, problem.sigma, 1e-12, 1e-12, false,
                                                  false, static_cast<unsigned>(seed) + 1000 * restart));
    try {
      algorithm.evolve(candidates);
    } catch (const TargetReached&) {
      outcome.solved = true;
      return outcome;
    }
    for (Eigen::Index i = 0; i < from.size(); ++i) from[i] = start[i] + problem.sigma * rng.normal();
  }
  return outcome;
}

void pagmo_ipop_rows(benchmark::State& state, const Case& problem) { descend(state, problem, pagmo_ipop); }
#endif

void register_rows(const Case& problem, const std::vector<std::int64_t>& dimensions) {
  for (const std::int64_t n : dimensions) {
    const std::string name = std::string("cma_es/") + problem.name + "/";
    const auto add = [&](const std::string& solver, void (*rows)(benchmark::State&, const Case&)) {
      benchmark::RegisterBenchmark((name + solver).c_str(), rows, problem)->Arg(n)->Unit(benchmark::kMillisecond);
    };
    add("surefoot", surefoot_ipop);
    if (problem.function == rastrigin.function) add("surefoot_bipop", surefoot_bipop);
#ifdef SUREFOOT_HAS_PAGMO
    add("pagmo", pagmo_ipop_rows);
#endif
  }
}

[[maybe_unused]] const bool registered = [] {
  register_rows(sphere, {6, 12, 40});
  register_rows(elli, {6, 12, 40});
  register_rows(rosenbrock, {6, 12});
  register_rows(rastrigin, {6});
  return true;
}();

// A fit of 12 parameters to 3,000 residuals with a numeric Jacobian: the size of a walk calibration.
void least_squares_fit(benchmark::State& state) {
  surefoot::Rng rng(1);
  Eigen::MatrixXd inputs(3000, 12);
  for (double& value : inputs.reshaped()) value = rng.uniform(-1, 1);
  VectorXd seen = inputs.rowwise().sum().array().sin();
  const auto residuals = [&](const VectorXd& p) -> VectorXd { return (inputs * p).array().sin().matrix() - seen; };
  for (auto _ : state) benchmark::DoNotOptimize(surefoot::least_squares(residuals, VectorXd::Constant(12, 0.8)));
}
BENCHMARK(least_squares_fit)->Unit(benchmark::kMillisecond);

}  // namespace

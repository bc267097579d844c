// Definitions of surefoot/optimize/cma_es_loop.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/optimize/cma_es_core.hpp"
#include "surefoot/optimize/cma_es_loop.hpp"
#include "surefoot/optimize/cma_es_stop.hpp"
#include "surefoot/optimize/rank_noise.hpp"
#include "surefoot/optimize/restarts.hpp"
#include "surefoot/optimize/search_space.hpp"

namespace surefoot::detail {

// One search under way.
class CmaEsLoop {
 public:
  CmaEsLoop(CmaEsSearch search, const CmaEsOptions& options, const CmaEsEnvironment& environment)
      : search_(std::move(search)),
        options_(options),
        environment_(environment),
        space_(search_.box),
        core_(search_.state) {}

  CmaEsResult run() {
    if (search_.evaluations == 0 && generation_cost() > evaluations_left()) {
      throw OptimizeError("CmaEsOptions: max_evaluations must cover one generation, " +
                          std::to_string(generation_cost()) + " evaluations");
    }
    while (true) {
      if (best_value() <= options_.target) return result(StopReason::target_reached);
      if (environment_.in_any_process(environment_.stop.stop_requested())) return result(StopReason::stop_requested);
      if (const auto reason = descent_ended()) {
        if (!restart(*reason)) return result(*reason);
      }
      if (generation_cost() > evaluations_left()) return result(StopReason::max_evaluations);
      const bool late = search_.evaluations > 0 && seconds() >= options_.max_seconds;
      if (environment_.in_any_process(late)) return result(StopReason::time_budget);
      if (evaluate()) learn();
    }
  }

 private:
  std::optional<StopReason> descent_ended() const {
    if (search_.descent.evaluations >= search_.plan.max_evaluations) return StopReason::max_evaluations;
    return converged(core_.state(), options_.tolerances);
  }

  // Begins the next descent, if there is one.
  bool restart(StopReason reason) {
    const std::uint64_t number = search_.finished.size();
    Rng rng = Rng(search_.seed, number).stream(restart_stream);
    RestartSchedule schedule = search_.schedule;
    schedule.finished(search_.plan, number, search_.descent.evaluations);
    const auto plan =
        schedule.next(options_.restarts, options_.max_restarts, options_.population_growth, rng.stream(0));
    if (!plan) return false;
    search_.finished.push_back(record(reason));
    search_.schedule = schedule;
    search_.plan = *plan;
    search_.descent = {.population = plan->population};
    search_.noise_evaluations = std::max(1, options_.noise.evaluations);
    Eigen::VectorXd start = search_.start;
    if (search_.box) {
      start = search_.box->sample(rng);
    } else {
      for (double& x : start) x += search_.sigma * rng.normal();
    }
    core_ = CmaEsCore(cma_es_start(space_.to_search(start), search_.sigma * plan->sigma_factor, plan->population,
                                   search_.seed, number + 1));
    return true;
  }

  // How many times each candidate is evaluated: even where two halves are to be compared.
  std::uint64_t repetitions() const {
    if (!environment_.noisy) return 1;
    const double wanted = search_.noise_evaluations;
    return static_cast<std::uint64_t>(adapts_to_noise() ? 2 * std::ceil(wanted / 2) : wanted);
  }
  bool adapts_to_noise() const { return options_.noise.max_evaluations > std::max(1, options_.noise.evaluations); }
  std::uint64_t generation_cost() const { return repetitions() * static_cast<std::uint64_t>(core_.state().population); }

  std::uint64_t evaluations_left() const {
    return options_.max_evaluations - std::min(search_.evaluations, options_.max_evaluations);
  }

  // False if a stop came before all candidates were done.
  bool evaluate() {
    const Eigen::MatrixXd& candidates = core_.ask();
    const auto count = static_cast<std::size_t>(candidates.cols());
    generation_.points.resize(count);
    generation_.values.resize(count);
    generation_.first_half.resize(count);
    generation_.second_half.resize(count);
    generation_.repetitions = repetitions();
    generation_.common_random_numbers = options_.noise.common_random_numbers;
    generation_.rng = Rng(search_.seed, core_.state().descent).stream(noise_stream, core_.state().generation);
    for (std::size_t i = 0; i < count; ++i) {
      space_.to_user(candidates.col(static_cast<Eigen::Index>(i)), generation_.points[i]);
    }
    return environment_.evaluate(generation_);
  }

  void learn() {
    const std::vector<double>& values = generation_.values;
    const std::uint64_t cost = generation_cost();
    core_.tell(values);
    search_.evaluations += cost;
    search_.descent.evaluations += cost;
    ++search_.descent.generations;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isfinite(values[i]) && values[i] < search_.descent.best_value) {
        search_.descent.best_value = values[i];
        search_.descent.best = generation_.points[i];
      }
    }
    if (environment_.noisy && adapts_to_noise()) {
      const NoiseOptions& noise = options_.noise;
      const bool confused = rank_disorder(generation_.first_half, generation_.second_half) > noise.disorder;
      search_.noise_evaluations *= confused ? noise.growth : std::pow(noise.growth, -0.25);
      search_.noise_evaluations =
          std::clamp<double>(search_.noise_evaluations, std::max(1, noise.evaluations), noise.max_evaluations);
    }
    if (options_.on_progress) {
      search_.state = core_.state();
      environment_.once([&] { options_.on_progress(search_); });
    }
  }

  CmaEsDescent record(StopReason reason) const {
    CmaEsDescent descent = search_.descent;
    descent.reason = reason;
    descent.mean = space_.to_user(core_.state().mean);
    return descent;
  }

  double best_value() const {
    double best = search_.descent.best_value;
    for (const CmaEsDescent& descent : search_.finished) best = std::min(best, descent.best_value);
    return best;
  }

  CmaEsResult result(StopReason reason) {
    CmaEsResult result{.reason = reason, .evaluations = search_.evaluations, .descents = search_.finished};
    if (search_.descent.generations > 0) result.descents.push_back(record(reason));
    for (const CmaEsDescent& descent : result.descents) {
      if (descent.best_value < result.best_value) {
        result.best_value = descent.best_value;
        result.best = descent.best;
      }
    }
    search_.state = core_.state();
    result.search = std::move(search_);
    result.seconds = seconds();
    return result;
  }

  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count(); }

  // Streams of a descent; CmaEsCore draws its candidates from streams of two keys, these have three.
  static constexpr std::uint64_t noise_stream = 1, restart_stream = 2;

  CmaEsSearch search_;
  const CmaEsOptions& options_;
  const CmaEsEnvironment& environment_;
  SearchSpace space_;
  CmaEsCore core_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  CmaEsGeneration generation_;
};

SUREFOOT_INLINE CmaEsResult run_cma_es(CmaEsSearch search, const CmaEsOptions& options,
                                       const CmaEsEnvironment& environment) {
  return CmaEsLoop(std::move(search), options, environment).run();
}

}  // namespace surefoot::detail

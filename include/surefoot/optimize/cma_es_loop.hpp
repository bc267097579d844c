// The loop behind cma_es(): evaluates generations, learns, stops and restarts.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/optimize/cma_es_core.hpp"
#include "surefoot/optimize/cma_es_options.hpp"
#include "surefoot/optimize/cma_es_search.hpp"
#include "surefoot/optimize/cma_es_stop.hpp"
#include "surefoot/optimize/objective.hpp"
#include "surefoot/optimize/rank_noise.hpp"
#include "surefoot/optimize/restarts.hpp"
#include "surefoot/optimize/search_space.hpp"

namespace surefoot::detail {

// One search under way: the loop of cma_es.
template <Objective F, Executor E>
class CmaEsLoop {
 public:
  CmaEsLoop(const F& objective, CmaEsSearch search, const CmaEsOptions& options, const E& executor,
            std::stop_token stop)
      : objective_(objective),
        search_(std::move(search)),
        options_(options),
        executor_(executor),
        stop_(std::move(stop)),
        space_(search_.box),
        core_(search_.state) {}

  CmaEsResult run() {
    if (search_.evaluations == 0 && generation_cost() > evaluations_left()) {
      throw OptimizeError("CmaEsOptions: max_evaluations must cover one generation, " +
                          std::to_string(generation_cost()) + " evaluations");
    }
    while (true) {
      if (best_value() <= options_.target) return result(StopReason::target_reached);
      if (in_any_process(executor_, stop_.stop_requested())) return result(StopReason::stop_requested);
      if (const auto reason = descent_ended()) {
        if (!restart(*reason)) return result(*reason);
      }
      if (generation_cost() > evaluations_left()) return result(StopReason::max_evaluations);
      const bool late = search_.evaluations > 0 && seconds() >= options_.max_seconds;
      if (in_any_process(executor_, late)) return result(StopReason::time_budget);
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
    if constexpr (ExactObjective<F>) {
      return 1;
    } else {
      const double wanted = search_.noise_evaluations;
      return static_cast<std::uint64_t>(adapts_to_noise() ? 2 * std::ceil(wanted / 2) : wanted);
    }
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
    points_.resize(count);
    values_.resize(count);
    first_half_.resize(count);
    second_half_.resize(count);
    const std::uint64_t repetitions = this->repetitions();
    const Rng rng = Rng(search_.seed, core_.state().descent).stream(noise_stream, core_.state().generation);
    for (std::size_t i = 0; i < count; ++i) {
      space_.to_user(candidates.col(static_cast<Eigen::Index>(i)), points_[i]);
    }
    return fill(
        executor_, count,
        [&](std::size_t i) {
          if constexpr (ExactObjective<F>) {
            values_[i] = objective_(points_[i]);
          } else {
            double sums[2] = {0, 0};
            for (std::uint64_t r = 0; r < repetitions; ++r) {
              Rng own = options_.noise.common_random_numbers ? rng.stream(r) : rng.stream(r, i + 1);
              sums[r < (repetitions + 1) / 2 ? 0 : 1] += objective_(std::as_const(points_[i]), own);
            }
            first_half_[i] = sums[0];
            second_half_[i] = sums[1];
            values_[i] = (sums[0] + sums[1]) / static_cast<double>(repetitions);
          }
        },
        stop_, Results<double>{values_}, Results<double>{first_half_}, Results<double>{second_half_});
  }

  void learn() {
    const std::uint64_t cost = generation_cost();
    core_.tell(values_);
    search_.evaluations += cost;
    search_.descent.evaluations += cost;
    ++search_.descent.generations;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if (std::isfinite(values_[i]) && values_[i] < search_.descent.best_value) {
        search_.descent.best_value = values_[i];
        search_.descent.best = points_[i];
      }
    }
    if (NoisyObjective<F> && adapts_to_noise()) {
      const NoiseOptions& noise = options_.noise;
      const bool confused = rank_disorder(first_half_, second_half_) > noise.disorder;
      search_.noise_evaluations *= confused ? noise.growth : std::pow(noise.growth, -0.25);
      search_.noise_evaluations =
          std::clamp<double>(search_.noise_evaluations, std::max(1, noise.evaluations), noise.max_evaluations);
    }
    if (options_.observer) {
      search_.state = core_.state();
      once(executor_, [&] { options_.observer(search_); });
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

  const F& objective_;
  CmaEsSearch search_;
  const CmaEsOptions& options_;
  const E& executor_;
  std::stop_token stop_;
  SearchSpace space_;
  CmaEsCore core_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::vector<Eigen::VectorXd> points_;  // the candidates in the user's coordinates
  std::vector<double> values_, first_half_, second_half_;
};

}  // namespace surefoot::detail

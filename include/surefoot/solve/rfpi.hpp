// Regression Forests Policy Iteration: solves a continuous-state, continuous-action MDP from its simulator alone.
// After Hofer & Rouxel, "An operational method toward efficient walk control policies for humanoid robots", ICAPS 2017.
// The value of a state and the best action in it are learnt by forests of extremely randomized trees, over and over, on
// the states that the policy visits. RfpiOptions{} is our own, far faster way; RfpiOptions::paper() is the published
// one.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi_backup.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/rfpi_rollouts.hpp"
#include "surefoot/solve/rfpi_state.hpp"

namespace surefoot {

template <Problem P>
struct RfpiResult {
  ForestPolicy<P> policy;             // the best one
  Estimate cost;                      // minus its mean return, on runs used for nothing else
  std::vector<RfpiProgress> history;  // one entry per iteration
  RfpiStop stop = RfpiStop::budget;
};

namespace detail {

/// Passes a stop request on, and makes one of its own when the time is up.
class TimeLimit {
 public:
  TimeLimit(std::stop_token outer, double seconds) : forward_(std::move(outer), Request{&source_}) {
    if (!(seconds < 1e9)) return;  // 30 years: as good as no limit, and no overflow of the clock
    timer_ = std::jthread([this, seconds](std::stop_token ended) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any never;
      never.wait_for(lock, ended, std::chrono::duration<double>(std::max(0.0, seconds)), [] { return false; });
      if (!ended.stop_requested()) {
        struck_ = true;
        source_.request_stop();
      }
    });
  }

  std::stop_token token() const { return source_.get_token(); }
  bool struck() const { return struck_; }

 private:
  struct Request {
    std::stop_source* source;
    void operator()() const { source->request_stop(); }
  };
  std::stop_source source_;
  std::atomic<bool> struck_ = false;
  std::stop_callback<Request> forward_;
  std::jthread timer_;
};

/// A number that tells runs apart: the seed, the options that matter, and how the problem answers a few questions.
template <Problem P>
std::uint64_t rfpi_fingerprint(const P& problem, const RfpiOptions& o, std::uint64_t seed,
                               std::span<const typename P::State> seed_states) {
  ByteWriter all;
  all.u64(seed);
  const auto number = [&all](auto... values) { (all.f64(static_cast<double>(values)), ...); };
  number(o.discount, o.horizon, o.value_method, o.first_states, o.steady_iterations, o.growth, o.max_states,
         o.blind_iterations, o.box_share, o.visited_share, o.exploration, o.backup_steps, o.backup_runs,
         o.backup_weight, o.remember, o.value_runs, o.evaluation_runs);
  const LookaheadOptions& l = o.lookahead;
  number(l.candidates, l.samples, l.corners, l.common_noise, l.kept, l.refined, l.refined_samples, l.spread, l.softness,
         l.radius);
  for (const ExtraTreesOptions* f : {&o.value_forest, &o.policy_forest}) {
    number(f->trees, f->candidates, f->min_leaf, f->max_depth, f->max_leaves, f->bootstrap, f->threshold_rule,
           f->model_score, f->ridge, f->clamp);
  }
  for (const auto& state : seed_states) all.words(std::span<const double>(state.data(), P::state_dim));
  all.list(feature_probe(problem));
  Rng rng(seed, 0);
  typename P::State state = problem.initial_state(rng);
  for (int i = 0; i < 3; ++i) {
    const auto step = problem.step(state, problem.action_box().sample(rng), rng);
    number(step.reward, step.terminal);
    all.words(std::span<const double>(step.next.data(), P::state_dim));
    state = step.next;
  }
  return checksum(all.bytes());
}

inline void check(const RfpiOptions& o) {
  auto require = [](bool good, const char* what) {
    if (!good) throw SolveError(std::string("RfpiOptions: ") + what);
  };
  auto share = [](double x) { return x >= 0 && x <= 1; };
  require(o.budget.seconds > 0 && o.budget.wall_seconds > 0, "budget.seconds and budget.wall_seconds must be positive");
  require(o.budget.step_ns >= 0, "budget.step_ns must not be negative");
  require(o.discount > 0 && o.discount <= 1, "discount must be in (0, 1]");
  require(o.horizon >= 1, "horizon must be at least 1");
  require(o.max_iterations >= 0, "max_iterations must be at least 1, or 0 for no limit");
  require(o.first_states >= 1 && o.max_states >= o.first_states,
          "first_states must be at least 1 and at most max_states");
  require(o.growth >= 1, "growth must be at least 1");
  require(o.blind_iterations >= 1, "blind_iterations must be at least 1: the first policy comes from one");
  require(share(o.box_share) && share(o.visited_share) && share(o.exploration) && share(o.backup_weight),
          "box_share, visited_share, exploration and backup_weight must be in [0, 1]");
  require(o.backup_steps >= 0 && o.backup_runs >= 1 && o.value_runs >= 1,
          "backup_steps must not be negative; backup_runs and value_runs must be at least 1");
  const LookaheadOptions& l = o.lookahead;
  require(l.candidates >= 1 && l.samples >= 1, "lookahead.candidates and lookahead.samples must be at least 1");
  require(l.refined >= 0, "lookahead.refined must not be negative");
  require(l.refined == 0 || (l.refined_samples >= 1 && l.kept >= 1),
          "lookahead.kept and lookahead.refined_samples must be at least 1");
  require(l.softness >= 0 && l.spread >= 0 && l.radius >= 0,
          "lookahead.softness, lookahead.spread and lookahead.radius must not be negative");
  require(o.evaluation_runs >= 2, "evaluation_runs must be at least 2");
  require(!o.resume || !o.checkpoint.empty(), "resume needs the name of the checkpoint file");
  try {
    surefoot::check(o.value_forest);
    surefoot::check(o.policy_forest);
  } catch (const ForestError& error) {
    require(false, error.what());
  }
}

}  // namespace detail

/// Learns a policy for `problem`. Same problem, options, seed and seed states: same bits, whatever the executor and
/// whether in one go or resumed from a checkpoint. `seed_states` are states worth knowing about from the start, e.g.
/// those of a few runs of an expert; none are needed. If `stop` is requested (Ctrl-C), the best policy so far comes
/// back. Throws SolveError for bad options, a checkpoint of another run, or a stop before there is a policy.
template <Problem P, Executor E>
RfpiResult<P> rfpi(const P& problem, const RfpiOptions& options, const E& executor, std::uint64_t seed,
                   std::span<const typename P::State> seed_states = {}, std::stop_token stop = {}) {
  using Clock = std::chrono::steady_clock;
  detail::check(options);
  const auto wall_start = Clock::now();
  const std::clock_t cpu_start = std::clock();
  const bool keep_checkpoint = !options.checkpoint.empty();
  const std::uint64_t fingerprint = detail::rfpi_fingerprint(problem, options, seed, seed_states);

  RfpiState<P> state;
  if (options.resume) {
    const std::vector<Bytes> found = map(executor, 1, [&](std::size_t) {  // one process reads
      std::vector<Bytes> file;
      if (std::filesystem::exists(options.checkpoint)) file.push_back(read_file(options.checkpoint));
      return file;
    })[0];
    if (!found.empty()) state = load_checkpoint<P>(found[0], options.checkpoint, fingerprint);
  }
  for (RfpiProgress& past : state.history) past.share = past.counted_seconds / options.budget.seconds;
  const RfpiProgress resumed = state.history.empty() ? RfpiProgress{} : state.history.back();
  const detail::TimeLimit limit(std::move(stop), options.budget.wall_seconds - resumed.seconds);
  const RolloutOptions evaluation{.runs = options.evaluation_runs, .horizon = options.horizon};
  const auto evaluate_policy = [&](const typename ForestPolicy<P>::ActionForest& forest, int runs,
                                   std::uint64_t stream) {
    RolloutOptions many = evaluation;
    many.runs = runs;
    Estimate cost = evaluate(problem, ForestPolicy<P>(problem, forest), many, executor, Rng(seed, stream).bits(), {});
    cost.mean = -cost.mean;
    return cost;
  };

  const auto stopped = [&] { return in_any_process(executor, limit.token().stop_requested()); };
  RfpiStop reason = RfpiStop::budget;
  std::optional<Clock::time_point> last_write;  // by the process that writes
  double last_work = 0;                         // of the last iteration [nominal s]
  bool unsaved = false;
  while (true) {
    if (options.max_iterations > 0 && state.iteration >= options.max_iterations) {
      reason = RfpiStop::iterations;
      break;
    }
    const double used = state.work.seconds(options.budget);
    const double left = options.budget.seconds - used;
    if (state.history.size() > 1) {
      last_work = used - state.history[state.history.size() - 2].counted_seconds;
    }
    if (left <= 0.3 * last_work) break;
    const Rng rng(seed, 1, static_cast<std::uint64_t>(state.iteration));
    RfpiState<P> next;
    try {
      if (options.value_method == ValueMethod::backup) {
        const int grown = std::max(0, state.iteration - options.steady_iterations);
        double count = std::min<double>(options.max_states, options.first_states * std::pow(options.growth, grown));
        // The last iteration takes what is left.
        if (grown > 0 && last_work > 0) count *= std::clamp(left / (last_work * options.growth), 0.1, 1.0);
        next = detail::improve_by_backup(problem, options, state, static_cast<std::size_t>(count), seed_states,
                                         executor, rng, limit.token());
      } else {
        next = detail::improve_by_rollouts(problem, options, state, seed_states, executor, rng, limit.token());
      }
    } catch (const Error&) {  // work that a stop left incomplete
      if (!stopped()) throw;
    }
    if (stopped()) {
      reason = in_any_process(executor, limit.struck()) ? RfpiStop::wall_clock : RfpiStop::requested;
      break;
    }
    next.history = std::move(state.history);
    RfpiProgress progress;
    progress.iteration = next.iteration;
    progress.states = next.samples.size();
    progress.leaves = next.policy.leaves();
    progress.cost = evaluate_policy(next.policy, options.evaluation_runs, 2).mean;
    next.work.steps +=
        static_cast<std::uint64_t>(options.evaluation_runs) * static_cast<std::uint64_t>(options.horizon);
    next.work.lookups += static_cast<std::uint64_t>(options.evaluation_runs) *
                         static_cast<std::uint64_t>(options.horizon) * next.policy.trees();
    const bool better = next.history.empty() || progress.cost <= state.best_cost;
    next.best_cost = progress.best_cost = better ? progress.cost : state.best_cost;
    next.best_policy = better ? next.policy : std::move(state.best_policy);
    progress.counted_seconds = next.work.seconds(options.budget);
    progress.share = progress.counted_seconds / options.budget.seconds;
    progress.seconds = resumed.seconds + std::chrono::duration<double>(Clock::now() - wall_start).count();
    progress.cpu_seconds = resumed.cpu_seconds + static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    next.history.push_back(progress);
    state = std::move(next);
    unsaved = true;
    once(executor, [&] {
      if (options.on_progress) options.on_progress(progress);
      const bool due = !last_write ||
                       std::chrono::duration<double>(Clock::now() - *last_write).count() >= options.checkpoint_seconds;
      if (keep_checkpoint && due) {
        save_checkpoint(options.checkpoint, fingerprint, state);
        last_write = Clock::now();
        unsaved = false;
      }
    });
  }
  once(executor, [&] {
    if (keep_checkpoint && unsaved) save_checkpoint(options.checkpoint, fingerprint, state);
  });
  if (state.best_policy.empty()) throw SolveError("rfpi: stopped before there was a first policy: give it more time");

  // The last policy learnt most and the best one was lucky: new runs decide between the two, others tell the cost.
  const int runs = 4 * options.evaluation_runs;
  const bool newest = evaluate_policy(state.policy, runs, 3).mean <= evaluate_policy(state.best_policy, runs, 3).mean;
  auto& chosen = newest ? state.policy : state.best_policy;
  const Estimate cost = evaluate_policy(chosen, runs, 4);
  return {ForestPolicy<P>(problem, std::move(chosen)), cost, std::move(state.history), reason};
}

/// For a type that is not a Problem: one compile error that names the missing member.
template <class P>
  requires(!Problem<P>)
auto rfpi(const P&, const RfpiOptions&, auto&&...) {
  return explain_problem<P>();
}

}  // namespace surefoot

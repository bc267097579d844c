// Regression Forests Policy Iteration: solves a continuous-state, continuous-action MDP from its simulator alone.
// After Hofer & Rouxel, "An operational method toward efficient walk control policies for humanoid robots", ICAPS 2017.
// The value of a state and the best action in it are learnt by forests of extremely randomized trees, over and over, on
// the states that the policy visits. RfpiOptions{} is our own, far faster way; RfpiOptions::paper() is the published
// one.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi_adapt.hpp"
#include "surefoot/solve/rfpi_backup.hpp"
#include "surefoot/solve/rfpi_hints.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/rfpi_rollouts.hpp"
#include "surefoot/solve/rfpi_state.hpp"
#include "surefoot/solve/time_limit.hpp"

namespace surefoot {

template <Problem P>
struct RfpiResult {
  ForestPolicy<P> policy;             // the best one
  Estimate cost;                      // minus its mean return, on runs used for nothing else
  std::vector<RfpiProgress> history;  // one entry per iteration
  RfpiStop stop = RfpiStop::budget;
  std::vector<std::string> hints;  // what speaks against discount, horizon or exploration, in plain words; see hints()
};

namespace detail {

/// A number that tells runs apart: the seed, the options that matter, and how the problem answers a few questions.
template <Problem P>
std::uint64_t rfpi_fingerprint(const P& problem, const RfpiOptions& o, std::uint64_t seed,
                               std::span<const typename P::State> seed_states) {
  ByteWriter all;
  all.u64(seed);
  const auto number = [&all](auto... values) { (all.f64(static_cast<double>(values)), ...); };
  number(o.discount, o.horizon, o.value_method, o.first_states, o.fixed_size_iterations, o.growth, o.max_states,
         o.initial_iterations, o.box_share, o.visited_share, o.exploration, o.backup_steps, o.backup_runs,
         o.backup_weight, o.reuse_previous_samples, o.value_runs, o.evaluation_runs);
  const LookaheadOptions& l = o.lookahead;
  number(l.candidates, l.samples, l.corners, l.common_noise, l.kept, l.refined, l.refined_samples, l.step, l.softness,
         l.radius);
  for (const ExtraTreesOptions* f : {&o.value_forest, &o.policy_forest}) {
    number(f->trees, f->candidates, f->min_leaf, f->max_depth, f->max_leaves, f->bootstrap, f->threshold_rule,
           f->model_score, f->ridge, f->clamp);
    if (f->draws != 1 || f->split_samples != 0) number(f->draws, f->split_samples);  // not in version 0.1
  }
  if (o.adapt || std::isfinite(o.agreement) || l.hold != 1) number(o.adapt, o.agreement, l.hold);  // not in version 0.1
  if (o.replace_short_runs) number(o.replace_short_runs);                                          // likewise
  if (o.try_following || l.follow != 0) number(o.try_following, l.follow);                         // likewise
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

/// One call of rfpi(), step by step.
template <Problem P, Executor E>
class RfpiRun {
 public:
  using States = std::span<const typename P::State>;

  RfpiRun(const P& problem, RfpiOptions options, const E& executor, std::uint64_t seed, States seed_states,
          std::stop_token stop)
      : problem_(problem),
        options_(std::move(options)),
        executor_(executor),
        seed_(seed),
        seed_states_(seed_states),
        fingerprint_(rfpi_fingerprint(problem, options_, seed, seed_states)),
        resumed_(resume()),
        limit_(std::move(stop), options_.max_seconds - resumed_.seconds) {}

  RfpiResult<P> work() {
    RfpiStop reason = RfpiStop::budget;
    while (true) {
      if (options_.max_iterations > 0 && state_.iteration >= options_.max_iterations) {
        reason = RfpiStop::iterations;
        break;
      }
      const double used = state_.work.seconds(options_.budget);
      const double left = options_.budget.counted_seconds - used;
      if (state_.history.size() > 1) {
        last_work_ = used - state_.history[state_.history.size() - 2].counted_seconds;
      }
      if (left <= 0.3 * last_work_) break;
      RfpiState<P> next = improve(left);
      if (stopped()) {
        reason = in_any_process(executor_, limit_.struck()) ? RfpiStop::wall_clock : RfpiStop::requested;
        break;
      }
      accept(std::move(next));
    }
    once(executor_, [&] {
      if (unsaved_ && !options_.checkpoint.empty()) save_checkpoint(options_.checkpoint, fingerprint_, state_);
    });
    return choose(reason);
  }

 private:
  static constexpr int patience = 5;  // iterations in a row that may be clearly worse before it goes back to the best
                                      // policy: values that come from far away make some worse on the way
  static constexpr double clearly_worse = 0.1;  // of the best policy's cost

  /// Whether what was learnt is being forgotten.
  bool forgets(const RfpiState<P>& next) const {
    return next.iteration > options_.initial_iterations &&
           next.cost > next.best_cost + clearly_worse * std::abs(next.best_cost);
  }

  using Clock = std::chrono::steady_clock;
  using ActionForest = typename ForestPolicy<P>::ActionForest;

  /// Takes the state from the checkpoint if there is one; its last entry.
  RfpiProgress resume() {
    if (options_.resume) {
      const std::vector<Bytes> found = map(executor_, 1, [&](std::size_t) {  // one process reads
        std::vector<Bytes> file;
        if (file_exists(options_.checkpoint)) file.push_back(read_file(options_.checkpoint));
        return file;
      })[0];
      if (!found.empty()) state_ = load_checkpoint<P>(found[0], options_.checkpoint, fingerprint_);
    }
    for (RfpiProgress& past : state_.history) past.share = past.counted_seconds / options_.budget.counted_seconds;
    return state_.history.empty() ? RfpiProgress{} : state_.history.back();
  }

  bool stopped() const { return in_any_process(executor_, limit_.token().stop_requested()); }

  /// The state after one more iteration, with `left` nominal seconds of the budget; of no use after a stop.
  RfpiState<P> improve(double left) const {
    const Rng rng(seed_, 1, static_cast<std::uint64_t>(state_.iteration));
    try {
      if (options_.value_method == ValueMethod::rollouts) {
        return improve_by_rollouts(problem_, options_, state_, seed_states_, executor_, rng, evaluation_seed(2),
                                   limit_.token());
      }
      const int grown = std::max(0, state_.iteration - options_.fixed_size_iterations);
      double count = std::min<double>(options_.max_states, options_.first_states * std::pow(options_.growth, grown));
      // The last iteration takes what is left.
      if (grown > 0 && last_work_ > 0) count *= std::clamp(left / (last_work_ * options_.growth), 0.1, 1.0);
      return improve_by_backup(problem_, options_, state_, static_cast<std::size_t>(count), seed_states_, executor_,
                               rng, evaluation_seed(2), limit_.token());
    } catch (const Error&) {  // work that a stop left incomplete
      if (!stopped()) throw;
    }
    return {};
  }

  std::uint64_t evaluation_seed(std::uint64_t stream) const { return Rng(seed_, stream).bits(); }

  /// Minus the mean return over `runs` runs from random numbers of `stream`.
  Estimate cost_of(const ActionForest& forest, int runs, std::uint64_t stream) const {
    return policy_cost(problem_, forest, options_, runs, executor_, evaluation_seed(stream)).cost;
  }

  void accept(RfpiState<P> next) {
    next.history = std::move(state_.history);
    RfpiProgress progress;
    progress.iteration = next.iteration;
    progress.states = next.samples.size();
    progress.leaves = next.policy.leaves();
    progress.cost = next.cost;
    const bool better = next.history.empty() || progress.cost <= state_.best_cost;
    next.best_cost = progress.best_cost = better ? progress.cost : state_.best_cost;
    next.best_policy = better ? next.policy : std::move(state_.best_policy);
    next.worse = forgets(next) ? state_.worse + 1 : 0;
    if (next.worse >= patience) {
      next.policy = next.best_policy;
      next.worse = 0;
    }
    progress.counted_seconds = next.work.seconds(options_.budget);
    progress.share = progress.counted_seconds / options_.budget.counted_seconds;
    progress.seconds = resumed_.seconds + std::chrono::duration<double>(Clock::now() - wall_start_).count();
    progress.cpu_seconds = resumed_.cpu_seconds + static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC;
    next.history.push_back(progress);
    state_ = std::move(next);
    unsaved_ = true;
    once(executor_, [&] { report(progress); });
  }

  /// Tells the user, and writes the checkpoint if it is due. In the process that writes files.
  void report(const RfpiProgress& progress) {
    if (options_.on_progress) options_.on_progress(progress);
    if (options_.checkpoint.empty()) return;
    const bool due = !last_write_ ||
                     std::chrono::duration<double>(Clock::now() - *last_write_).count() >= options_.checkpoint_seconds;
    if (!due) return;
    save_checkpoint(options_.checkpoint, fingerprint_, state_);
    last_write_ = Clock::now();
    unsaved_ = false;
  }

  /// The last policy learnt most and the best one was lucky: new runs decide between the two, others tell the cost.
  RfpiResult<P> choose(RfpiStop reason) {
    if (state_.best_policy.empty()) {
      throw SolveError("rfpi: stopped before there was a first policy: give it more time");
    }
    const int runs = 4 * evaluation_runs(options_);
    const bool newest = cost_of(state_.policy, runs, 3).mean <= cost_of(state_.best_policy, runs, 3).mean;
    auto& chosen = newest ? state_.policy : state_.best_policy;
    const Estimate cost = cost_of(chosen, runs, 4);
    ForestPolicy<P> policy(problem_, std::move(chosen), options_.agreement);
    const LearningSigns signs = learning_signs(problem_, policy, options_.horizon, evaluation_seed(6));
    return {std::move(policy), cost, std::move(state_.history), reason, hints(signs, options_)};
  }

  const P& problem_;
  RfpiOptions options_;
  const E& executor_;
  std::uint64_t seed_;
  States seed_states_;
  Clock::time_point wall_start_ = Clock::now();
  std::clock_t cpu_start_ = std::clock();
  std::uint64_t fingerprint_;
  RfpiState<P> state_;
  RfpiProgress resumed_;
  TimeLimit limit_;
  std::optional<Clock::time_point> last_write_;  // by the process that writes
  double last_work_ = 0;                         // of the last iteration [nominal s]
  bool unsaved_ = false;
};

}  // namespace detail

/// Learns a policy for `problem`. Same problem, options, seed and seed states: same bits, whatever the executor and
/// whether in one go or resumed from a checkpoint. `seed_states` are states worth knowing about from the start, e.g.
/// those of a few runs of an expert; none are needed. If `stop` is requested (Ctrl-C), the best policy so far comes
/// back. Throws SolveError for bad options, a checkpoint of another run, or a stop before there is a policy.
template <Problem P, Executor E>
RfpiResult<P> rfpi(const P& problem, const RfpiOptions& options, const E& executor, std::uint64_t seed,
                   std::span<const typename P::State> seed_states = {}, std::stop_token stop = {}) {
  check(options);
  RfpiOptions adapted = resolved(options);
  if (options.adapt && options.value_method == ValueMethod::backup &&
      detail::is_deterministic(problem, options.horizon, Rng(seed, 5))) {
    adapted = detail::without_noise(std::move(adapted));
  }
  return detail::RfpiRun<P, E>(problem, std::move(adapted), executor, seed, seed_states, std::move(stop)).work();
}

/// For a type that is not a Problem: one compile error that names the missing member.
template <class P>
requires(!Problem<P>) auto rfpi(const P&, const RfpiOptions&, auto&&...) { return explain_problem<P>(); }

}  // namespace surefoot

// Options of `rfpi()`, its progress reports, and why it stopped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/options.hpp"

namespace surefoot {

/// How much work to do. It is counted, not measured: every simulated step, forest look-up and fit has a nominal price,
/// so the same budget means the same work, and the same result, on any machine and any number of threads.
struct Budget {
  double counted_seconds = 300;  // of one nominal core, all threads together
  double step_ns = 80;           // nominal price of one step of the problem [ns]
};

/// How an action is looked for from a state by simulating one transition (see lookahead.hpp).
struct LookaheadOptions {
  int candidates = 11;       // actions of the first stage: incumbent, centre, corners, random ones
  int samples = 3;           // simulated transitions of each
  bool corners = true;       // false: all candidates are random
  bool common_noise = true;  // all candidates meet the same noise, spread evenly (Latin hypercube)
  int kept = 6;              // best candidates that go to the second stage
  int refined = 12;          // actions of the second stage, those kept included; 0: no second stage
  int refined_samples = 7;   // simulated transitions of each
  double step = 0.4;         // of new actions away from those kept [half widths of the action box]
  double softness = 0.1;     // the action is the mean of those about as good as the best: scale of "about"
                             // [gap between the best and the median action]; 0: the best alone
  int hold = 1;              // transitions that each action is held for before the value counts
  int follow = 0;            // transitions of the policy after those, before the value counts
  double radius = 0.6;       // and no further from the best than this [half widths of the action box, root mean square]
};

/// How the value of a state is found.
enum class ValueMethod {
  backup,    // lookahead, and a few steps of the policy, on top of the last value forest
  rollouts,  // mean discounted return of simulated runs of the policy, as in the paper
};

struct RfpiOptions {
  Budget budget = {};
  double max_seconds = std::numeric_limits<double>::infinity();  // wall clock; if it strikes, the result depends on the
                                                                 // speed of the machine [s]
  int max_iterations = 0;                                        // 0: no limit but the budget
  double discount = 0;                                           // per transition; 0: 1 - 1 / horizon
  int horizon = 50;                                              // [transitions] of every simulated run

  ValueMethod value_method = ValueMethod::backup;
  LookaheadOptions lookahead = {};
  ExtraTreesOptions value_forest = {.trees = 12, .min_leaf = 20, .model_score = false};
  // What the robot carries.
  ExtraTreesOptions policy_forest = {.trees = 4, .draws = 4, .min_leaf = 30, .max_leaves = 2000, .split_samples = 300};

  // ValueMethod::backup: every iteration samples new states and forgets older ones.
  int first_states = 3000;         // samples of the first iterations
  int fixed_size_iterations = 12;  // iterations of that size, before the number grows
  double growth = 1.25;            // factor per iteration from then on
  int max_states = 400'000;        // where growth ends
  int initial_iterations = 6;      // first iterations, on states from the whole state box, before there is a policy
  double box_share = 0.05;         // of the samples from the whole state box, later
  double visited_share = 0.5;      // of the samples from runs of the newest policy; the rest stays from before
  bool replace_short_runs = false;  // more runs where runs end early, until visited_share is reached; false: as many as
                                    // whole runs would take
  bool try_following = false;  // now and then, whether lookaheads do better that follow the policy for some transitions
  double exploration = 0.3;        // chance per step of those runs to hold a random action for 1 to 3 steps
  int backup_steps = 2;        // steps of the policy after the lookahead's action, before the last value forest counts
  int backup_runs = 4;         // simulated runs of those steps
  double backup_weight = 0.5;  // of their mean; the rest is the lookahead's own value
  bool reuse_previous_samples = true;  // once the number grows, the forests also learn from the iteration before

  // ValueMethod::rollouts: all states ever visited are kept; policy n is improved after n more runs.
  int value_runs = 20;  // simulated runs per state

  double agreement = 0.5;  // actions of trees that are further apart are of different opinions, and the policy does
                           // what most say [half widths of the action box]; infinite: the mean of all
  bool adapt = true;  // finds out by itself: whether there is noise (else single samples, longer backups), how much
                      // exploration runs survive, for how long lookaheads hold an action, how many leaves, up to
                      // policy_forest's, do best
  int evaluation_runs = 0;  // runs, always the same, that tell which policy is the best; 0: 50'000 transitions of them
  std::string checkpoint = {};    // file to resume from; empty: none is written
  double checkpoint_seconds = 5;  // wall time between two writes of it; the first follows the first iteration
  bool resume =
      false;  // continue from `checkpoint` if it is there: same problem, options and seed, same bits as one go
  std::function<void(const struct RfpiProgress&)> on_progress = {};  // called after every iteration; empty: silence

  /// Hofer & Rouxel, "An operational method toward efficient walk control policies for humanoid robots", ICAPS 2017,
  /// Algorithms 2 to 4 with the constants printed there.
  static RfpiOptions paper() {
    RfpiOptions options;
    options.value_method = ValueMethod::rollouts;
    options.max_iterations = 100;
    options.lookahead = {
        .candidates = 100, .samples = 10, .corners = false, .common_noise = false, .refined = 0, .softness = 0};
    options.value_forest = {.trees = 25, .min_leaf = 10};
    options.policy_forest = {.trees = 25, .min_leaf = 50, .model_score = true};
    options.reuse_previous_samples = false;
    options.discount = 0.98;
    options.agreement = std::numeric_limits<double>::infinity();
    options.evaluation_runs = 1000;
    options.adapt = false;
    return options;
  }
};

/// The state of affairs after an iteration.
struct RfpiProgress {
  int iteration = 0;
  double seconds = 0;          // wall time so far, that before a resume included
  double cpu_seconds = 0;      // of all threads of this process, likewise
  double counted_seconds = 0;  // work so far, as the budget counts it
  double share = 0;            // of the budget that is used, 0..1
  std::size_t states = 0;      // samples of this iteration
  double cost = 0;             // minus the mean return, not discounted, of the newest policy over the evaluation runs
  double best_cost = 0;        // of the best policy so far
  std::size_t leaves = 0;      // of the newest policy
};

/// The options with numbers in place of what is left to rfpi().
RfpiOptions resolved(RfpiOptions options);

/// Throws a SolveError that names the field and its range.
void check(const LookaheadOptions& options);
void check(const RfpiOptions& options);

enum class RfpiStop { budget, iterations, wall_clock, requested };

/// One sentence about why it stopped.
std::string explain(RfpiStop stop);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/solve/rfpi_options.ipp"
#endif

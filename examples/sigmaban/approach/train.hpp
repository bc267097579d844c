// `train`: RFPI from the states that Winner2016 visits, on the threads of one process or on many processes.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../../apps/common/files.hpp"
#include "../../../apps/common/interrupt.hpp"
#include "commands.hpp"
#include "motion.hpp"
#include "results.hpp"
#include "seed_states.hpp"
#include "surefoot/core/any_executor.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi.hpp"
#include "train_options.hpp"

namespace sigmaban {

inline void print_progress(const surefoot::RfpiProgress& p) {
  const double left = p.share > 0 ? p.seconds * std::max(0.0, 1 - p.share) / p.share : 0;
  std::printf("%7.1f s  iteration %3d  %7zu states  %4.0f iterations/min  cost %6.2f  best %6.2f  left %4.0f s\n",
              p.seconds, p.iteration, p.states, 60 * p.iteration / p.seconds, p.cost, p.best_cost, left);
  std::fflush(stdout);
}

template <class Problem>
nlohmann::ordered_json training_record(const TrainOptions& options, const surefoot::RfpiResult<Problem>& result) {
  nlohmann::ordered_json json{{"problem", options.problem}, {"preset", options.preset}, {"seed", options.seed},
                              {"budget", options.budget},   {"cost", result.cost.mean}, {"low", result.cost.low()},
                              {"high", result.cost.high()}};
  if (!options.motion.empty()) {
    const auto walk = result.policy.problem().walk.parameters();
    json["motion"] = options.motion;
    json["walk"] = std::vector<double>(walk.begin(), walk.end());
  }
  json["cpu_seconds"] = result.history.empty() ? 0 : result.history.back().cpu_seconds;
  json["history"] = nlohmann::json::array();
  for (const surefoot::RfpiProgress& p : result.history) {
    json["history"].push_back({{"iteration", p.iteration},
                               {"seconds", p.seconds},
                               {"cpu_seconds", p.cpu_seconds},
                               {"states", p.states},
                               {"cost", p.cost},
                               {"best_cost", p.best_cost}});
  }
  return json;
}

template <class Problem>
void train(const Problem& problem, const TrainOptions& options, const surefoot::AnyExecutor& executor) {
  surefoot::once(executor, [&] { example::prepare_output(options.out); });
  const example::Interrupt interrupt;
  const auto interrupted = [&] { return surefoot::in_any_process(executor, interrupt.requested()); };
  surefoot::RfpiOptions rfpi = options.preset == "paper" ? surefoot::RfpiOptions::paper() : surefoot::RfpiOptions{};
  rfpi.budget.counted_seconds = options.budget;
  rfpi.max_seconds = options.wall;
  rfpi.checkpoint = options.checkpoint();
  rfpi.checkpoint_seconds = options.checkpoint_seconds;
  rfpi.resume = options.resume;
  rfpi.on_progress = print_progress;
  try {
    surefoot::once(executor, [&] {
      if (!options.resume || std::filesystem::exists(rfpi.checkpoint)) return;
      std::printf("There is no %s yet: starting anew.\n", rfpi.checkpoint.c_str());
    });
    const auto result =
        surefoot::rfpi(problem, rfpi, executor, options.seed, seed_states(problem, options.seed), interrupt.token());
    surefoot::once(executor, [&] {
      surefoot::save_policy(options.out, result.policy);
      example::write_text(record_of(options.out), training_record(options, result).dump(1) + "\n");
      std::printf("%s: cost %.2f +- %.2f (95 %%); %s\n", options.out.c_str(), result.cost.mean,
                  result.cost.half_width(), surefoot::explain(result.stop).c_str());
      for (const std::string& hint : result.hints) std::printf("hint: %s\n", hint.c_str());
    });
  } catch (const surefoot::SolveError& error) {
    if (!interrupted()) throw;
    surefoot::once(executor, [&] { std::printf("%s\n", error.what()); });  // stopped too early: nothing to keep
  }
  if (interrupted()) throw Interrupted{};
}

// In files of their own: each instantiates all of RFPI.
extern template void train(const Approach&, const TrainOptions&, const surefoot::AnyExecutor&);
extern template void train(const CalibratedApproach&, const TrainOptions&, const surefoot::AnyExecutor&);

/// Trains on the executor that make_executor(options) gives, as a std::unique_ptr.
template <class MakeExecutor>
void train_on(const TrainOptions& options, MakeExecutor&& make_executor) {
  with_problem(options.problem, options.motion,
               [&](const auto& problem) { train(problem, options, surefoot::AnyExecutor(make_executor(options))); });
}

/// Adds the subcommand; `work(options)` trains. `threads`: the default.
template <class Work>
void add_train_by(CLI::App& program, std::size_t threads, Work work) {
  auto options = std::make_shared<TrainOptions>();
  options->threads = threads;
  CLI::App* command = program.add_subcommand("train", "Train a policy by RFPI; Ctrl-C ends early and keeps the best");
  add_problem_option(*command, options->problem);
  add_motion_option(*command, options->motion);
  command
      ->add_option("--budget", options->budget,
                   "work in seconds of one nominal core, all threads together: the same policy on any machine")
      ->check(CLI::Range(0.1, 1e7))
      ->capture_default_str();
  command->add_option("--max-wall", options->wall, "[s] hard limit by the clock")->check(CLI::Range(0.1, 1e7));
  command->add_option("--seed", options->seed, "same seed, same policy")->capture_default_str();
  add_threads_option(*command, options->threads);
  command->add_option("--out", options->out, "policy file; FILE.json tells how it was trained")->required();
  command->add_option("--preset", options->preset, "default: ours; paper: the settings of the paper")
      ->check(CLI::IsMember({"default", "paper"}))
      ->capture_default_str();
  command->add_option("--checkpoint-every", options->checkpoint_seconds, "[s] between two writes of FILE.checkpoint")
      ->check(CLI::Range(0.0, 1e7))
      ->capture_default_str();
  command->add_flag("--resume", options->resume, "go on from FILE.checkpoint, if it is there");
  command->callback([options, work] { work(*options); });
}

}  // namespace sigmaban

// `train`: RFPI from the states that Winner2016 visits.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../common/files.hpp"
#include "../common/interrupt.hpp"
#include "commands.hpp"
#include "motion.hpp"
#include "results.hpp"
#include "seed_states.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi.hpp"

namespace sigmaban {
namespace {

using example::Interrupt;
using example::prepare_output;
using example::write_text;

struct Options {
  std::string problem, motion;
  std::string preset = "default";
  double budget = 300;                                    // [s] of one nominal core
  double wall = std::numeric_limits<double>::infinity();  // [s]
  std::uint64_t seed = 1;
  std::size_t threads = 0;
  std::filesystem::path out;
  double checkpoint_seconds = 10;
  bool resume = false;
};

void print_progress(const surefoot::RfpiProgress& p) {
  const double left = p.share > 0 ? p.seconds * std::max(0.0, 1 - p.share) / p.share : 0;
  std::printf("%7.1f s  iteration %3d  %7zu states  %4.0f iterations/min  cost %6.2f  best %6.2f  left %4.0f s\n",
              p.seconds, p.iteration, p.states, 60 * p.iteration / p.seconds, p.cost, p.best_cost, left);
  std::fflush(stdout);
}

template <class Problem>
nlohmann::ordered_json record(const Options& options, const surefoot::RfpiResult<Problem>& result) {
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
void run(const Problem& problem, const Options& options) {
  prepare_output(options.out);
  const Interrupt interrupt;
  surefoot::RfpiOptions rfpi = options.preset == "paper" ? surefoot::RfpiOptions::paper() : surefoot::RfpiOptions{};
  rfpi.budget.seconds = options.budget;
  rfpi.budget.wall_seconds = options.wall;
  rfpi.checkpoint = options.out.string() + ".checkpoint";
  rfpi.checkpoint_seconds = options.checkpoint_seconds;
  rfpi.resume = options.resume && std::filesystem::exists(rfpi.checkpoint);
  rfpi.on_progress = print_progress;
  if (options.resume && !rfpi.resume) std::printf("There is no %s yet: starting anew.\n", rfpi.checkpoint.c_str());
  try {
    const auto result = surefoot::rfpi(problem, rfpi, surefoot::Threads(options.threads), options.seed,
                                       seed_states(problem, options.seed), interrupt.token());
    surefoot::save_policy(options.out, result.policy);
    write_text(record_of(options.out), record(options, result).dump(1) + "\n");
    std::printf("%s: cost %.2f +- %.2f (95 %%); %s\n", options.out.c_str(), result.cost.mean, result.cost.half_width(),
                surefoot::explain(result.stop).c_str());
  } catch (const surefoot::SolveError& error) {
    if (!interrupt.requested()) throw;
    std::printf("%s\n", error.what());  // stopped too early: there is nothing to keep
  }
  if (interrupt.requested()) throw Interrupted{};
}

}  // namespace

void add_train(CLI::App& program) {
  auto options = std::make_shared<Options>();
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
  command->callback([options] {
    with_problem(options->problem, options->motion, [&](const auto& problem) { run(problem, *options); });
  });
}

}  // namespace sigmaban

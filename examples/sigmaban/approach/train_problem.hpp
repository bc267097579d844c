// The training of a policy for one problem: compiled once for each, in a file of its own.
#pragma once

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../../apps/common/files.hpp"
#include "../../../apps/common/interrupt.hpp"
#include "../../../apps/common/usage_error.hpp"
#include "results.hpp"
#include "seed_states.hpp"
#include "surefoot/core/any_executor.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi.hpp"
#include "train.hpp"

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
  if (interrupted()) throw example::Interrupted{};
}

}  // namespace sigmaban

// `tune`: CMA-ES on the 15 parameters of Winner2016.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "../../../apps/common/files.hpp"
#include "../../../apps/common/interrupt.hpp"
#include "commands.hpp"
#include "motion.hpp"
#include "parameter_file.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/solve/policy_search.hpp"
#include "tune_options.hpp"
#include "winner2016.hpp"

namespace sigmaban {
namespace {

using example::Interrupt;
using example::prepare_output;
using example::write_text;

constexpr double run_seconds = 5.5e-6;  // nominal price of a simulated run

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Prints a line at most once per second.
class Progress {
 public:
  Progress(std::uint64_t budget, std::uint64_t runs_per_evaluation) : budget_(budget), unit_(runs_per_evaluation) {}

  void operator()(const surefoot::CmaEsSearch& search) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    if (elapsed.count() < printed_ + 1) return;
    printed_ = elapsed.count();
    const auto runs = static_cast<double>(search.evaluations * unit_);
    const double rate = runs / printed_;
    std::printf("%7.1f s  descent %2zu  generation %4llu  %9.0f runs (%.0f/s)  median cost %6.2f  left %4.0f s\n",
                printed_, search.finished.size() + 1, static_cast<unsigned long long>(search.state.generation), runs,
                rate, search.state.median_values.empty() ? 0.0 : search.state.median_values.back(),
                std::max(0.0, (static_cast<double>(budget_) - runs) / rate));
    std::fflush(stdout);
  }

 private:
  std::uint64_t budget_, unit_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double printed_ = 0;  // [s]
};

template <class Problem>
void run(const Problem& problem, const TuneOptions& options) {
  prepare_output(options.out);
  const Interrupt interrupt;
  surefoot::PolicySearchOptions search;
  search.horizon = Problem::horizon;
  search.total_runs = static_cast<std::uint64_t>(options.budget / run_seconds);
  search.max_seconds = options.wall;
  search.on_progress = Progress(search.total_runs, static_cast<std::uint64_t>(search.min_runs / 2));
  const auto make_policy = [](const Winner2016Parameters::Vector& values) {
    return Winner2016(Winner2016Parameters::from_vec(values));
  };
  const auto result =
      surefoot::policy_search(problem, make_policy, Winner2016Parameters::winner2016().vec(), winner2016_box(), search,
                              surefoot::Threads(options.threads), options.seed, interrupt.token());
  nlohmann::ordered_json json{{"policy", "winner2016"},       {"problem", options.problem},
                              {"seed", options.seed},         {"runs", result.runs},
                              {"cpu_seconds", cpu_seconds()}, {"cost", -result.value.mean},
                              {"low", -result.value.high()},  {"high", -result.value.low()}};
  if (!options.motion.empty()) json["motion"] = options.motion;
  json["parameters"] = to_json(Winner2016Parameters::from_vec(result.parameters));
  write_text(options.out, json.dump(2) + "\n");
  std::printf("%s: cost %.2f +- %.2f (95 %%) after %llu runs, best of %zu finalists\n", options.out.c_str(),
              -result.value.mean, result.value.half_width(), static_cast<unsigned long long>(result.runs),
              result.finalists.size());
  if (interrupt.requested()) throw Interrupted{};
}

}  // namespace

void tune_winner2016(const TuneOptions& options) {
  with_problem(options.problem, options.motion, [&](const auto& problem) { run(problem, options); });
}

void add_tune(example::Command& program) {
  auto options = std::make_shared<TuneOptions>();
  example::Command* command =
      program.add_subcommand("tune", "Tune Winner2016 by CMA-ES; Ctrl-C ends early and keeps the best");
  add_problem_option(*command, options->problem);
  add_motion_option(*command, options->motion);
  command
      ->add_option("--budget", options->budget,
                   "work in seconds of one nominal core, all threads together: the same parameters on any machine")
      ->check(example::between(0.01, 1e7))
      ->capture_default_str();
  command->add_option("--max-wall", options->wall, "[s] hard limit by the clock")->check(example::between(0.1, 1e7));
  command->add_option("--seed", options->seed, "same seed, same parameters")->capture_default_str();
  add_threads_option(*command, options->threads);
  command->add_option("--out", options->out, "parameter file (JSON)")->required();
  command->callback([options] { tune_winner2016(*options); });
}

}  // namespace sigmaban

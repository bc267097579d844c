// `evaluate`: the mean cost of a policy.
#include <chrono>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "any_policy.hpp"
#include "commands.hpp"
#include "motion.hpp"

namespace sigmaban {
namespace {

struct EvaluateOptions {
  std::string problem, policy, motion, robot;
  int trials = 10'000;
  std::uint64_t seed = evaluation_seed;
  std::size_t threads = 0;
  bool json = false;
};

template <class Problem>
void run(const Problem& problem, const EvaluateOptions& options) {
  check_motion(options.policy, options.motion);
  const auto policy = load_any_policy(problem, options.policy);
  Problem played = problem;
  if constexpr (std::same_as<Problem, CalibratedApproach>) {
    if (!options.robot.empty()) played = calibrated_approach(options.problem, options.robot);
  }
  const auto start = std::chrono::steady_clock::now();
  const auto cost = mean_cost(played, policy, options.trials, options.seed, surefoot::Threads(options.threads));
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  if (options.json) {
    const nlohmann::ordered_json json{{"problem", options.problem}, {"policy", options.policy},
                                      {"trials", options.trials},   {"seed", options.seed},
                                      {"cost", cost.mean},          {"low", cost.low()},
                                      {"high", cost.high()},        {"seconds", elapsed.count()}};
    std::cout << json.dump(2) << '\n';
  } else {
    std::printf("%s, %s: cost %.3f +- %.3f (95 %%), %d trials of %d walk cycles in %.2f s\n", options.problem.c_str(),
                options.policy.c_str(), cost.mean, cost.half_width(), options.trials, Problem::horizon,
                elapsed.count());
  }
}

}  // namespace

void add_evaluate(example::Command& program) {
  auto options = std::make_shared<EvaluateOptions>();
  example::Command* command = program.add_subcommand("evaluate", "Measure the mean cost of a policy");
  add_problem_option(*command, options->problem);
  add_motion_option(*command, options->motion);
  command
      ->add_option("--robot", options->robot,
                   "motion.json of the robot that plays, where it is another than the policy believes (--motion)")
      ->needs("--motion")
      ->check(example::existing_file());
  command->add_option("--policy", options->policy, "winner2016, tuned, or a file written by train or tune")->required();
  command->add_option("--trials", options->trials, "independent runs")
      ->check(example::between(2, 100'000'000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of starts and noise")->capture_default_str();
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options] {
    with_problem(options->problem, options->motion, [&](const auto& problem) { run(problem, *options); });
  });
}

}  // namespace sigmaban

// `play`: what policies for the ball approach cost on the twin.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "../../../apps/calibrate/stoppable.hpp"
#include "../../../apps/common/files.hpp"
#include "../approach/any_policy.hpp"
#include "../approach/commands.hpp"
#include "../approach/motion.hpp"
#include "../robot/policy_option.hpp"
#include "commands.hpp"
#include "play_approach.hpp"
#include "progress_line.hpp"
#include "share.hpp"

namespace sigmaban {
namespace {

using calibrate_program::StoppableThreads;

struct PlayOptions {
  TwinOptions twin;
  std::string problem, motion;
  std::vector<std::string> policies;
  int episodes = 200, model_trials = 10'000;
  std::filesystem::path out;
};

/// Of one policy.
struct Score {
  std::string policy;
  surefoot::Estimate cost, model_cost;  // on the twin, and in the model that the policy believes in
  Share success, falls, lost;           // success: the robot came to where it may kick
  double median_kick = 0;               // cycles until then, of the successful; 0: none was
};

template <class Problem>
std::vector<PlayedApproach> play_all(const Problem& problem, const AnyPolicyOf<Problem>& policy,
                                     const PlayOptions& options, const std::string& name,
                                     const StoppableThreads& threads) {
  const WalkingTwinOptions twin = walking_twin_options(options.twin);
  const auto count = static_cast<std::size_t>(options.episodes);
  std::vector<std::optional<PlayedApproach>> played(count);
  std::mutex one_at_a_time;
  std::size_t done = 0;
  ProgressLine progress("approaches of " + name, count);
  threads.run(count, [&](std::size_t i) {
    const surefoot::Rng rng(options.twin.seed, i);
    surefoot::Rng start = rng.stream(0);
    WalkingTwin robot(twin, rng.stream(2));
    const auto state = problem.initial_state(start);
    played[i] =
        std::visit([&](const auto& p) { return play_approach(problem, p, robot, state, rng.stream(1)); }, policy);
    const std::scoped_lock lock(one_at_a_time);
    progress(++done);
  });
  std::vector<PlayedApproach> result;
  for (auto& one : played) {
    if (one) result.push_back(std::move(*one));
  }
  return result;
}

double median(std::vector<int> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

Score score(const std::vector<PlayedApproach>& played) {
  Score result;
  std::vector<double> costs;
  std::vector<int> kicks;
  for (const PlayedApproach& one : played) {
    costs.push_back(one.cost);
    if (one.kick) kicks.push_back(*one.kick);
    result.falls.yes += one.fell ? 1 : 0;
    result.lost.yes += one.lost ? 1 : 0;
  }
  result.cost = surefoot::estimate(costs);
  result.success.yes = kicks.size();
  result.success.trials = result.falls.trials = result.lost.trials = played.size();
  result.median_kick = median(std::move(kicks));
  return result;
}

void print(const Score& s) {
  std::printf("%-24s %7.2f +- %5.2f %10.2f   %5.1f %% (%.1f to %.1f) %8.1f %6zu %6zu\n", s.policy.c_str(), s.cost.mean,
              s.cost.half_width(), s.model_cost.mean, 100 * s.success.value(), 100 * s.success.low(),
              100 * s.success.high(), s.median_kick, s.lost.yes, s.falls.yes);
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const PlayOptions& options, const std::vector<Score>& scores) {
  nlohmann::ordered_json json{{"problem", options.problem},        {"motion", options.motion},
                              {"switches", options.twin.switches}, {"noise_rad", options.twin.noise},
                              {"seed", options.twin.seed},         {"policies", nlohmann::json::array()}};
  for (const Score& s : scores) {
    json["policies"].push_back(
        {{"policy", s.policy},
         {"episodes", s.cost.runs},
         {"cost", {{"mean", s.cost.mean}, {"low", s.cost.low()}, {"high", s.cost.high()}}},
         {"model_cost", s.model_cost.mean},
         {"success", {{"share", s.success.value()}, {"low", s.success.low()}, {"high", s.success.high()}}},
         {"median_cycles_to_kick", s.median_kick},
         {"lost", s.lost.yes},
         {"fell", s.falls.yes}});
  }
  return json;
}

template <class Problem>
void run_problem(const Problem& problem, const PlayOptions& options) {
  if (!options.out.empty()) example::prepare_output(options.out);
  std::vector<AnyPolicyOf<Problem>> policies;
  for (const std::string& name : options.policies)
    policies.push_back(load_policy_option(problem, name, options.motion));
  std::vector<Score> scores;
  calibrate_program::until_interrupted(options.twin.threads, [&](const StoppableThreads& threads) {
    std::printf("%-24s %16s %10s   %22s %8s %6s %6s\n", "policy", "cost (95 %)", "in model", "may kick (95 %)", "after",
                "lost", "fell");
    for (std::size_t i = 0; i < policies.size(); ++i) {
      const auto played = play_all(problem, policies[i], options, options.policies[i], threads);
      if (played.empty()) break;
      scores.push_back(score(played));
      scores.back().policy = options.policies[i];
      scores.back().model_cost =
          mean_cost(problem, policies[i], options.model_trials, options.twin.seed, threads.threads);
      print(scores.back());
      if (played.size() < static_cast<std::size_t>(options.episodes)) break;
    }
    if (!options.out.empty()) example::write_text(options.out, to_json(options, scores).dump(2) + "\n");
  });
}

}  // namespace

void add_play(example::Command& program) {
  auto options = std::make_shared<PlayOptions>();
  example::Command* command = program.add_subcommand("play", "Play whole ball approaches and tell what they cost");
  command->footer(
      "All policies meet the same starts, those of `sigmaban_approach evaluate` with the same seed. A fall ends a run\n"
      "and costs what losing the ball does. Columns: mean cost on the twin; in the model that the policy was made "
      "for;\n"
      "share of runs in which the robot came to where it may kick, after how many walk cycles (median); balls lost;\n"
      "falls. Ctrl-C ends early and keeps what is done.");
  add_problem_option(*command, options->problem);
  add_motion_option(*command, options->motion);
  command->add_option("--policy", options->policies, std::string(policy_help) + "; several times")->required();
  command->add_option("--episodes", options->episodes, "approaches of each policy")
      ->check(example::between(2, 1'000'000))
      ->capture_default_str();
  add_twin_options(*command, options->twin);
  command->add_option("--out", options->out, "JSON file with the same figures");
  command->callback([options] {
    with_problem(options->problem, options->motion, [&](const auto& problem) { run_problem(problem, *options); });
  });
}

}  // namespace sigmaban

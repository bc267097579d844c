// `table4`: the paper's experiment on the robot, whole, on the twin.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "../../../apps/calibrate/stoppable.hpp"
#include "../../../apps/common/files.hpp"
#include "../../../apps/common/usage_error.hpp"
#include "../approach/any_policy.hpp"
#include "../approach/motion.hpp"
#include "../approach/results.hpp"
#include "../robot/policy_option.hpp"
#include "../robot/walk/walk_run.hpp"
#include "commands.hpp"
#include "progress_line.hpp"
#include "table4.hpp"
#include "table4_policies.hpp"
#include "table4_robot.hpp"

namespace sigmaban {
namespace {

using calibrate_program::StoppableThreads;
using example::UsageError;

struct Table4Options {
  Table4Work work;
  SimulatedCamera camera;
  int runs = 5;                   // from each start
  double longest = 120;           // of an approach [s]
  std::vector<double> published;  // [s]
  WalkRun robot;                  // where it has ports, a robot walks in place of the twin
  bool on_robot() const { return !robot.ports.empty(); }
};

/// What the figures depend on, but for the number of runs.
std::string settings_text(const Table4Options& o) {
  const nlohmann::ordered_json json{
      {"switches", o.work.twin.switches}, {"noise_rad", o.work.twin.noise},    {"seed", o.work.twin.seed},
      {"sequences", o.work.sequences},    {"tune_budget", o.work.tune_budget}, {"train_budget", o.work.train_budget},
      {"longest_s", o.longest},           {"sighted", o.camera.seen},          {"robot", o.on_robot()}};
  return json.dump(1) + "\n";
}

/// Throws UsageError if the folder holds results of other settings.
void keep_settings(const Table4Options& options) {
  const auto file = options.work.folder / "settings.json";
  const std::string text = settings_text(options);
  if (exists(file) && example::read_text(file) != text) {
    throw UsageError(file.string() + ": this folder was made with other settings, give another --out or delete it");
  }
  example::write_text(file, text);
}

/// One problem and its three policies, in the order of table4_policies.
struct Contest {
  CalibratedApproach problem;
  std::vector<AnyPolicyOf<CalibratedApproach>> policies;
};

Contest load_contest(const std::string& name, const Table4Work& work) {
  const std::string motion = work.motion();
  const Results results{work.folder};
  Contest contest{calibrated_approach(name, motion), {}};
  for (const std::string& policy : {std::string("expert"), results.tuned(name).string(), results.rfpi(name).string()}) {
    contest.policies.push_back(load_policy_option(contest.problem, policy, motion));
  }
  return contest;
}

/// Runs with the same number meet the same sightings, whatever the policy.
KickApproach walk(const Contest& contest, const Table4Row& row, const Table4Options& options) {
  const auto policy =
      static_cast<std::size_t>(std::ranges::find(table4_policies, row.policy) - table4_policies.begin());
  const auto start = static_cast<std::size_t>(row.start);
  const surefoot::Rng rng(options.work.twin.seed, static_cast<std::uint64_t>(12 * row.run + row.start));
  WalkingTwin robot(walking_twin_options(options.work.twin), rng.stream(2));
  return std::visit(
      [&](const auto& p) {
        return walk_to_kick(contest.problem, p, robot, table4_starts()[start], options.camera, options.longest, rng);
      },
      contest.policies[policy]);
}

/// Appends each approach to the file as it ends.
void walk_missing(const Table4Options& options, const std::filesystem::path& file, const Table4Approaches& all) {
  const Contest ha = load_contest("ha", options.work), anha = load_contest("anha", options.work);
  std::string text = table4_header;
  for (const Table4Row& row : all.done) text += to_csv(row);
  example::write_text(file, text);  // without what a program that was killed left unfinished
  std::ofstream out(file, std::ios::app);
  std::mutex one_at_a_time;
  ProgressLine progress("approaches", all.missing.size());
  calibrate_program::until_interrupted(options.work.twin.threads, [&](const StoppableThreads& threads) {
    std::size_t count = 0;
    threads.run(all.missing.size(), [&](std::size_t i) {
      Table4Row row = all.missing[i];
      row.approach = walk(row.problem == "ha" ? ha : anha, row, options);
      const std::scoped_lock lock(one_at_a_time);
      out << to_csv(row) << std::flush;
      progress(++count);
    });
  });
}

/// One after the other, each when the robot is in its place.
void walk_missing_on_robot(const Table4Options& options, const std::filesystem::path& file,
                           const Table4Approaches& all) {
  std::string text = table4_header;
  for (const Table4Row& row : all.done) text += to_csv(row);
  for (Table4Row row : all.missing) {
    const Results results{options.work.folder};
    WalkRun run = options.robot;
    run.problem = row.problem;
    run.motion = options.work.motion();
    run.seconds = options.longest;
    if (row.policy == "CMA-ES") run.policy = results.tuned(row.problem);
    if (row.policy == "RFPI") run.policy = results.rfpi(row.problem);
    row.approach = walk_on_robot(row, run);
    text += to_csv(row);
    example::write_text(file, text);
  }
}

void print(const std::vector<Table4Row>& rows, const Table4Options& options) {
  std::printf("\nMean time until the robot stands still where it may kick [s], 95 %% bounds; starts reached of 12\n");
  std::printf("%-8s %-12s %16s %9s %6s %6s %6s %10s\n", "problem", "policy", options.on_robot() ? "robot" : "twin",
              "reached", "runs", "fell", "lost", "published");
  std::size_t i = 0;
  for (const std::string_view problem : table4_problems) {
    for (const std::string_view policy : table4_policies) {
      const Table4Cell cell = table4_cell(rows, problem, policy);
      char published[16] = "-";
      if (i < options.published.size()) std::snprintf(published, sizeof published, "%.2f", options.published[i]);
      ++i;
      char width[16] = "-";  // of a single run from each start it is not known
      if (std::isfinite(cell.half_width)) std::snprintf(width, sizeof width, "%.1f", cell.half_width);
      std::printf("%-8s %-12s %s%7.1f +- %4s %9d %6d %6d %6d %10s\n", problem == "ha" ? "HA" : "ANHA",
                  std::string(policy).c_str(), cell.failed > 0 ? ">" : " ", cell.seconds, width, cell.reached,
                  cell.runs, cell.fell, cell.lost, published);
    }
  }
}

nlohmann::ordered_json to_json(const std::vector<Table4Row>& rows, const Table4Options& options) {
  nlohmann::ordered_json json{{"settings", nlohmann::ordered_json::parse(settings_text(options))},
                              {"rows", nlohmann::json::array()}};
  for (const std::string_view problem : table4_problems) {
    for (const std::string_view policy : table4_policies) {
      const Table4Cell cell = table4_cell(rows, problem, policy);
      json["rows"].push_back({{"problem", problem},
                              {"policy", policy},
                              {"seconds", cell.seconds},
                              {"half_width", std::isfinite(cell.half_width) ? cell.half_width : -1},
                              {"starts_reached", cell.reached},
                              {"runs", cell.runs},
                              {"failed", cell.failed},
                              {"fell", cell.fell},
                              {"lost", cell.lost}});
    }
  }
  return json;
}

void run(const Table4Options& options) {
  if (options.on_robot() && options.work.given_motion.empty()) {
    throw UsageError("--port: give the walk of that robot, too, as surefoot-calibrate fit wrote it: --motion FILE");
  }
  example::prepare_output(options.work.folder / "table4.json");
  keep_settings(options);
  make_table4_policies(options.work);
  const auto file = options.work.folder / "approaches.csv";
  const auto in_file = [&] { return table4_approaches(exists(file) ? example::read_text(file) : "", options.runs); };
  Table4Approaches all = in_file();
  if (!all.missing.empty()) {
    std::printf("== walking, %zu approaches\n", all.missing.size());
    std::fflush(stdout);
    options.on_robot() ? walk_missing_on_robot(options, file, all) : walk_missing(options, file, all);
    all = in_file();  // in the same order as if nothing had ever been stopped
  }
  print(all.done, options);
  example::write_text(options.work.folder / "table4.json", to_json(all.done, options).dump(2) + "\n");
}

constexpr const char* footer =
    "Twelve starts: ball at 0.5 and 1 m, ahead, left and right; kick target ahead and behind. Winner2016, the same "
    "tuned\n"
    "by CMA-ES, and RFPI, in both problems. The robot knows of the ball what a camera sees: not in every cycle, with\n"
    "noise, and at times something else. Time runs from the first command until it has not moved for a walk cycle in\n"
    "the kick area; with --port a robot walks, and says when to put it into its place. > marks a mean with approaches "
    "that did not get there. Ctrl-C stops; the same command goes on.";

/// What makes it an experiment on a robot.
void add_robot_options(example::Command& command, Table4Options& options) {
  options.robot.ports.clear();
  auto* port = command
                   .add_option("--port", options.robot.ports,
                               "a robot walks in place of the twin: its serial ports, with commas; virtual: simulated "
                               "servos, and the ball as the motion model has it")
                   ->delimiter(',');
  const auto of_robot = [&](example::Option* option) { option->needs(port); };
  of_robot(command.add_option("--motion", options.work.given_motion, "motion.json of the robot's walk")
               ->check(example::existing_file()));
  of_robot(command.add_option("--joints", options.robot.joints_file, "as for surefoot-walk")
               ->check(example::existing_file()));
  of_robot(command.add_option("--ball-from", options.robot.ball_from, "as for surefoot-walk"));
  of_robot(command.add_option("--baud", options.robot.bits_per_s, "[bit/s]")->capture_default_str());
  of_robot(command.add_option("--protocol", options.robot.protocol, "of the servos")
               ->check(example::one_of({1, 2}))
               ->capture_default_str());
}

}  // namespace

void add_table4(example::Command& program) {
  auto options = std::make_shared<Table4Options>();
  example::Command* command =
      program.add_subcommand("table4", "The paper's experiment: time from twelve starts to a stand in the kick area");
  command->footer(footer);
  command->add_option("--out", options->work.folder, "folder for all that is made; goes on with what is there")
      ->required();
  command->add_option("--runs", options->runs, "from each start")
      ->check(example::between(1, 1000))
      ->capture_default_str();
  command->add_option("--longest", options->longest, "[s] of an approach")
      ->check(example::between(1.0, 1e4))
      ->capture_default_str();
  command->add_option("--sighted", options->camera.seen, "share of walk cycles in which the camera sees the ball")
      ->check(example::between(0.05, 1.0))
      ->capture_default_str();
  command->add_option("--sequences", options->work.sequences, "recorded for the calibration")
      ->check(example::between(3, 10'000))
      ->capture_default_str();
  command
      ->add_option("--tune-budget", options->work.tune_budget,
                   "of tuning for each problem, in seconds of one nominal core")
      ->check(example::between(0.01, 1e7))
      ->capture_default_str();
  command
      ->add_option("--train-budget", options->work.train_budget,
                   "of training for each problem, in seconds of one nominal core")
      ->check(example::between(0.1, 1e7))
      ->capture_default_str();
  command
      ->add_option(
          "--published", options->published,
          "[s] six figures of the published table, to be printed beside: Winner2016, CMA-ES, RFPI for HA, then "
          "for ANHA")
      ->expected(6);
  add_twin_options(*command, options->work.twin);
  add_robot_options(*command, *options);
  command->callback([options] { run(*options); });
}

}  // namespace sigmaban

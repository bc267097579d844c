// `table`: the paper's table 3 beside what the policies in a folder of results really cost.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../../../apps/common/files.hpp"
#include "any_policy.hpp"
#include "commands.hpp"
#include "published.hpp"
#include "results.hpp"

namespace sigmaban {
namespace {

using example::read_text;
using example::write_text;

struct TableOptions {
  Results results{"results"};
  std::filesystem::path out;  // empty: table.json among the results
  int trials = 10'000;
  std::uint64_t seed = evaluation_seed;
  std::size_t threads = 0;
};

struct Row {
  std::string policy, problem;
  std::optional<double> paper;             // published cost
  std::optional<surefoot::Estimate> ours;  // measured here, or by dynamic programming for the last row
  std::optional<double> cpu_seconds;       // of training or tuning
};

/// What `train` and `tune` noted about their work, if the file is there.
std::optional<double> cpu_seconds(const std::filesystem::path& record) {
  if (!exists(record)) return std::nullopt;
  const auto json = nlohmann::json::parse(read_text(record), nullptr, false);
  if (!json.is_object() || !json.contains("cpu_seconds") || !json["cpu_seconds"].is_number()) return std::nullopt;
  return json["cpu_seconds"].get<double>();
}

std::vector<Row> rows(const TableOptions& options, const std::string& name) {
  const Approach problem = problem_named(name);
  const Published& known = published(name);
  const Results& results = options.results;
  const surefoot::Threads threads(options.threads);
  const auto cost = [&](const std::string& policy) {
    return mean_cost(problem, load_any_policy(problem, policy), options.trials, options.seed, threads);
  };
  const auto cost_of_file = [&](const std::filesystem::path& file) -> std::optional<surefoot::Estimate> {
    if (!exists(file)) return std::nullopt;
    return cost(file.string());
  };
  const surefoot::Estimate near_optimal{known.near_optimal, known.near_optimal_half_width / 1.96, 10'000};
  return {
      {"Winner2016", name, known.winner2016, cost("winner2016"), std::nullopt},
      {"public tuned parameters", name, std::nullopt, cost("tuned"), std::nullopt},
      {"tuned by CMA-ES", name, known.tuned, cost_of_file(results.tuned(name)), cpu_seconds(results.tuned(name))},
      {"RFPI, settings of the paper", name, known.rfpi, cost_of_file(results.paper(name)),
       cpu_seconds(record_of(results.paper(name)))},
      {"RFPI", name, std::nullopt, cost_of_file(results.rfpi(name)), cpu_seconds(record_of(results.rfpi(name)))},
      {"near-optimal (grid)", name, std::nullopt, near_optimal, std::nullopt},
  };
}

void print(const std::vector<Row>& table) {
  std::printf("%-8s %-28s %8s %16s %12s\n", "problem", "policy", "paper", "ours (95 %)", "CPU seconds");
  for (const Row& row : table) {
    char paper[16] = "-", ours[32] = "not there", cpu[16] = "-";
    if (row.paper) std::snprintf(paper, sizeof paper, "%.2f", *row.paper);
    if (row.ours) std::snprintf(ours, sizeof ours, "%.2f +- %.2f", row.ours->mean, row.ours->half_width());
    if (row.cpu_seconds) std::snprintf(cpu, sizeof cpu, "%.0f", *row.cpu_seconds);
    std::printf("%-8s %-28s %8s %16s %12s\n", row.problem == "ha" ? "HA" : "ANHA", row.policy.c_str(), paper, ours,
                cpu);
  }
}

nlohmann::ordered_json to_json(const std::vector<Row>& table, const TableOptions& options) {
  nlohmann::ordered_json json{{"trials", options.trials}, {"seed", options.seed}, {"rows", nlohmann::json::array()}};
  for (const Row& row : table) {
    nlohmann::ordered_json line{{"problem", row.problem}, {"policy", row.policy}};
    if (row.paper) line["paper"] = *row.paper;
    if (row.ours) {
      line["cost"] = row.ours->mean;
      line["low"] = row.ours->low();
      line["high"] = row.ours->high();
    }
    if (row.cpu_seconds) line["cpu_seconds"] = *row.cpu_seconds;
    json["rows"].push_back(line);
  }
  return json;
}

void run(const TableOptions& options) {
  std::vector<Row> table = rows(options, "ha");
  for (Row& row : rows(options, "anha")) table.push_back(std::move(row));
  print(table);
  std::printf("Mean cost of %d trials. The paper's RFPI took %.0f core-hours a problem.\n", options.trials,
              published_core_hours);
  const auto file = options.out.empty() ? options.results.folder / "table.json" : options.out;
  write_text(file, to_json(table, options).dump(2) + "\n");
}

}  // namespace

void add_table(example::Command& program) {
  auto options = std::make_shared<TableOptions>();
  example::Command* command =
      program.add_subcommand("table", "Print the paper's table 3 beside ours, and write it as JSON");
  command->add_option("--results", options->results.folder, "folder with the policies")->capture_default_str();
  command->add_option("--out", options->out, "JSON file; by default table.json among the results");
  command->add_option("--trials", options->trials, "independent runs for each policy")
      ->check(example::between(2, 100'000'000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of starts and noise")->capture_default_str();
  add_threads_option(*command, options->threads);
  command->callback([options] { run(*options); });
}

}  // namespace sigmaban

// The classic problems, one set of defaults for all:
//   classic_problems references FOLDER [NAME...]            what the returns are compared with: FOLDER/references.csv
//   classic_problems train FOLDER SECONDS SEEDS [NAME...]   SECONDS counted, seeds 1 to SEEDS: FOLDER/returns.csv and
//                                                           FOLDER/curves/NAME_SEED.dat
//   classic_problems table FOLDER                           both files as one table
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "case.hpp"
#include "results.hpp"

namespace {

using namespace classic;  // NOLINT(google-build-using-namespace): a program, not a header
namespace fs = std::filesystem;

std::vector<Case> chosen_cases(std::span<const std::string> names) {
  std::vector<Case> cases = all_cases();
  for (const std::string& name : names) {
    if (std::ranges::none_of(cases, [&](const Case& c) { return c.name == name; })) {
      throw std::runtime_error("there is no problem " + name);
    }
  }
  if (!names.empty()) {
    std::erase_if(cases, [&](const Case& c) { return std::ranges::find(names, c.name) == names.end(); });
  }
  return cases;
}

void compute_references(const fs::path& folder, std::span<const std::string> names) {
  std::vector<ReferenceRow> rows = read_references(folder);
  for (const Case& one : chosen_cases(names)) {
    const double start = cpu_seconds();
    const Reference reference = one.reference();
    std::erase_if(rows, [&](const ReferenceRow& row) { return row.name == one.name; });
    rows.push_back({one.name, reference.estimate.mean, reference.estimate.standard_error, reference.estimate.runs,
                    cpu_seconds() - start, reference.how});
    std::printf("%-14s %9.3f +- %.3f  %6.1f s  %s\n", one.name.c_str(), rows.back().mean,
                1.96 * rows.back().standard_error, rows.back().cpu_seconds, rows.back().how.c_str());
    std::fflush(stdout);
    write_references(folder, rows);
  }
}

void train(const fs::path& folder, double seconds, std::uint64_t seeds, std::span<const std::string> names) {
  std::vector<ReturnRow> rows = read_returns(folder);
  fs::create_directories(folder / "curves");
  for (const Case& one : chosen_cases(names)) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      surefoot::RfpiOptions options;
      options.budget.counted_seconds = seconds;
      const Training training = one.train(options, seed);
      std::erase_if(rows, [&](const ReturnRow& row) { return row.name == one.name && row.seed == seed; });
      rows.push_back({one.name, seed, training.estimate.mean, training.history.back().counted_seconds,
                      training.cpu_seconds, training.leaves, training.bytes, training.decision_ns});
      const ReturnRow& row = rows.back();
      std::printf("%-14s seed %d  %9.3f  %5.1f counted s  %5.1f CPU s  %6zu leaves  %5.0f ns\n", one.name.c_str(),
                  static_cast<int>(seed), row.mean, row.counted_seconds, row.cpu_seconds, row.leaves, row.decision_ns);
      std::fflush(stdout);
      std::ofstream curve(folder / "curves" / (one.name + "_" + std::to_string(seed) + ".dat"));
      curve << "# CPU seconds, return of the newest policy, of the best\n";
      for (const auto& p : training.history) curve << p.cpu_seconds << ' ' << -p.cost << ' ' << -p.best_cost << '\n';
      write_returns(folder, rows);
    }
  }
}

}  // namespace

int main(int count, char** words) try {
  const std::vector<std::string> arguments(words + 1, words + count);
  const auto from = [&](std::size_t first) { return std::span(arguments).subspan(first); };
  if (arguments.size() >= 2 && arguments[0] == "references") {
    compute_references(arguments[1], from(2));
  } else if (arguments.size() >= 4 && arguments[0] == "train") {
    train(arguments[1], std::stod(arguments[2]), std::stoul(arguments[3]), from(4));
  } else if (arguments.size() == 2 && arguments[0] == "table") {
    print_table(all_cases(), read_references(arguments[1]), read_returns(arguments[1]));
  } else {
    std::printf(
        "classic_problems references FOLDER [NAME...]\n"
        "classic_problems train FOLDER SECONDS SEEDS [NAME...]\n"
        "classic_problems table FOLDER\n");
    return 2;
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}

// The files of the results folder, and the table.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "case.hpp"
#include "published.hpp"

namespace classic {

struct ReferenceRow {
  std::string name;
  double mean = 0, standard_error = 0;
  std::size_t runs = 0;
  double cpu_seconds = 0;
  std::string how;
};

struct ReturnRow {
  std::string name;
  std::uint64_t seed = 0;
  double mean = 0, counted_seconds = 0, cpu_seconds = 0;
  std::size_t leaves = 0, bytes = 0;
  double decision_ns = 0;
};

/// Calls take(stream) with each line but the first, its commas as blanks except those of the last cell.
template <class Take>
void read_lines(const std::filesystem::path& file, int cells, const Take& take) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::size_t at = 0;
    for (int i = 1; i < cells && (at = line.find(',', at)) != std::string::npos; ++i) line[at] = ' ';
    std::istringstream words(line);
    take(words);
  }
}

inline std::vector<ReferenceRow> read_references(const std::filesystem::path& folder) {
  std::vector<ReferenceRow> rows;
  read_lines(folder / "references.csv", 6, [&](std::istream& in) {
    ReferenceRow row;
    in >> row.name >> row.mean >> row.standard_error >> row.runs >> row.cpu_seconds >> std::ws;
    std::getline(in, row.how);
    rows.push_back(row);
  });
  return rows;
}

inline void write_references(const std::filesystem::path& folder, const std::vector<ReferenceRow>& rows) {
  std::filesystem::create_directories(folder);
  std::ofstream out(folder / "references.csv");
  out << "problem,return,standard_error,runs,cpu_seconds,how\n";
  for (const ReferenceRow& r : rows) {
    out << r.name << ',' << r.mean << ',' << r.standard_error << ',' << r.runs << ',' << r.cpu_seconds << ',' << r.how
        << '\n';
  }
}

inline std::vector<ReturnRow> read_returns(const std::filesystem::path& folder) {
  std::vector<ReturnRow> rows;
  read_lines(folder / "returns.csv", 9, [&](std::istream& in) {
    ReturnRow row;
    in >> row.name >> row.seed >> row.mean >> row.counted_seconds >> row.cpu_seconds >> row.leaves >> row.bytes >>
        row.decision_ns;
    rows.push_back(row);
  });
  return rows;
}

inline void write_returns(const std::filesystem::path& folder, const std::vector<ReturnRow>& rows) {
  std::filesystem::create_directories(folder);
  std::ofstream out(folder / "returns.csv");
  out << "problem,seed,return,counted_seconds,cpu_seconds,leaves,bytes,decision_ns\n";
  for (const ReturnRow& r : rows) {
    out << r.name << ',' << r.seed << ',' << r.mean << ',' << r.counted_seconds << ',' << r.cpu_seconds << ','
        << r.leaves << ',' << r.bytes << ',' << r.decision_ns << '\n';
  }
}

/// The row in the middle by its return (of an even number the lower one).
inline ReturnRow median(std::vector<ReturnRow> rows) {
  std::ranges::sort(rows, {}, &ReturnRow::mean);
  return rows[(rows.size() - 1) / 2];
}

inline void print_table(const std::vector<Case>& cases, const std::vector<ReferenceRow>& references,
                        const std::vector<ReturnRow>& returns) {
  std::printf(
      "| problem | state, action | median return (seeds) | worst | reference | behind it by | CPU [s] | kB | ns | "
      "reference by |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Case& one : cases) {
    std::vector<ReturnRow> ours;
    std::ranges::copy_if(returns, std::back_inserter(ours), [&](const ReturnRow& r) { return r.name == one.name; });
    const auto reference = std::ranges::find(references, one.name, &ReferenceRow::name);
    if (ours.empty() || reference == references.end()) continue;
    const ReturnRow middle = median(ours);
    const double worst = std::ranges::min_element(ours, {}, &ReturnRow::mean)->mean;
    std::printf("| %s | %d, %d | %.2f (%zu) | %.2f | %.2f | %.1f %% | %.0f | %.0f | %.0f | %s |\n", one.name.c_str(),
                one.state_dim, one.action_dim, middle.mean, ours.size(), worst, reference->mean,
                100 * (reference->mean - middle.mean) / std::abs(reference->mean), middle.cpu_seconds,
                static_cast<double>(middle.bytes) / 1000, middle.decision_ns, reference->how.c_str());
  }
  std::printf("\npublished by others:\n");
  for (const Published& p : published) {
    std::printf("| %.*s | %.*s | %.2f | %.*s |\n", static_cast<int>(p.problem.size()), p.problem.data(),
                static_cast<int>(p.method.size()), p.method.data(), p.mean, static_cast<int>(p.source.size()),
                p.source.data());
  }
}

}  // namespace classic

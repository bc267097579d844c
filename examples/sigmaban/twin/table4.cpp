#include "table4.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>

#include "surefoot/core/rollout.hpp"

namespace sigmaban {

std::array<BallView, 12> table4_starts() {
  constexpr double left = std::numbers::pi / 2;
  std::array<BallView, 12> starts;
  std::size_t i = 0;
  for (const double distance : {0.5, 1.0}) {
    for (const double direction : {0.0, left, -left}) {
      for (const double kick : {0.0, std::numbers::pi}) {
        starts[i++] = {distance * std::cos(direction), distance * std::sin(direction), kick};
      }
    }
  }
  return starts;
}

std::string to_csv(const Table4Row& row) {
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(), "%s,%s,%d,%d,%.17g,%d,%d,%d\n", row.problem.c_str(), row.policy.c_str(),
                row.start, row.run, row.approach.seconds, row.approach.reached ? 1 : 0, row.approach.fell ? 1 : 0,
                row.approach.lost ? 1 : 0);
  return line.data();
}

std::vector<Table4Row> read_table4(const std::string& csv) {
  std::vector<Table4Row> rows;
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = csv.find('\n', begin)) != std::string::npos; begin = end + 1) {
    std::istringstream line(csv.substr(begin, end - begin));
    Table4Row row;
    char comma = 0;
    std::getline(line, row.problem, ',');
    std::getline(line, row.policy, ',');
    line >> row.start >> comma >> row.run >> comma >> row.approach.seconds >> comma >> row.approach.reached >> comma >>
        row.approach.fell >> comma >> row.approach.lost;
    if (line) rows.push_back(row);
  }
  return rows;
}

Table4Approaches table4_approaches(const std::string& csv, int runs) {
  const std::vector<Table4Row> known = read_table4(csv);
  Table4Approaches result;
  for (int run = 0; run < runs; ++run) {
    for (const std::string_view problem : table4_problems) {
      for (const std::string_view policy : table4_policies) {
        for (int start = 0; start < static_cast<int>(table4_starts().size()); ++start) {
          const Table4Row row{std::string(problem), std::string(policy), start, run, {}};
          const auto found = std::ranges::find_if(known, [&](const Table4Row& old) { return old.same_place(row); });
          found == known.end() ? result.missing.push_back(row) : result.done.push_back(*found);
        }
      }
    }
  }
  return result;
}

Table4Cell table4_cell(const std::vector<Table4Row>& rows, std::string_view problem, std::string_view policy) {
  Table4Cell cell;
  double variance = 0;
  for (int start = 0; start < static_cast<int>(table4_starts().size()); ++start) {
    std::vector<double> seconds;
    bool all = true;
    for (const Table4Row& row : rows) {
      if (row.problem != problem || row.policy != policy || row.start != start) continue;
      seconds.push_back(row.approach.seconds);
      all = all && row.approach.reached;
      cell.failed += row.approach.reached ? 0 : 1;
      cell.fell += row.approach.fell ? 1 : 0;
      cell.lost += row.approach.lost ? 1 : 0;
    }
    if (seconds.empty()) continue;
    const surefoot::Estimate mean = surefoot::estimate(seconds);
    cell.seconds += mean.mean;
    variance += mean.standard_error * mean.standard_error;
    cell.runs += static_cast<int>(seconds.size());
    cell.reached += all ? 1 : 0;
    ++cell.starts;
  }
  if (cell.starts == 0) return cell;
  cell.seconds /= cell.starts;
  cell.half_width = 1.96 * std::sqrt(variance) / cell.starts;
  return cell;
}

}  // namespace sigmaban

// The paper's experiment on the robot: how long three policies take from twelve starts until the robot stands where it
// may kick. Hofer and Rouxel, ICAPS 2017, table 4.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "../robot/walk/ball.hpp"
#include "kick_approach.hpp"

namespace sigmaban {

inline constexpr std::array<std::string_view, 2> table4_problems{"ha", "anha"};
inline constexpr std::array<std::string_view, 3> table4_policies{"Winner2016", "CMA-ES", "RFPI"};

/// Ball at 0.5 m and at 1 m, ahead, to the left and to the right; kick target ahead and behind.
std::array<BallView, 12> table4_starts();

/// One approach of the experiment.
struct Table4Row {
  std::string problem, policy;
  int start = 0, run = 0;  // both from 0
  KickApproach approach;

  bool same_place(const Table4Row& other) const {
    return problem == other.problem && policy == other.policy && start == other.start && run == other.run;
  }
};

inline constexpr const char* table4_header = "problem,policy,start,run,seconds,reached,fell,lost\n";

/// A line of CSV, with its end.
std::string to_csv(const Table4Row& row);

/// Lines that are no rows, the unfinished last one of a program that was killed too, are left out.
std::vector<Table4Row> read_table4(const std::string& csv);

/// The approaches that are wanted: those of a CSV file with their results, and those that are missing in it.
struct Table4Approaches {
  std::vector<Table4Row> done, missing;
};

/// `runs` of each start, problem and policy; all first runs come before all second ones.
Table4Approaches table4_approaches(const std::string& csv, int runs);

/// What became of one policy in one problem.
struct Table4Cell {
  double seconds = 0;     // mean over the starts [s]; approaches that did not get there count as long as they took
  double half_width = 0;  // of its 95 % interval, by the scatter of the runs of each start; infinite for single runs
  int reached = 0;        // starts from which every run got there
  int starts = 0;         // of which there are runs
  int failed = 0, fell = 0, lost = 0;  // runs
  int runs = 0;
};

Table4Cell table4_cell(const std::vector<Table4Row>& rows, std::string_view problem, std::string_view policy);

}  // namespace sigmaban

// The results of a comparison of two walks, as text and as compare.json.
#pragma once

#include <optional>
#include <string>

#include "joint_changes.hpp"
#include "surefoot/motion/walk_changes.hpp"

namespace calibrate_program {

struct ComparedWalks {
  surefoot::WalkComparison comparison;
  std::optional<surefoot::WalkFalls> falls;
  std::size_t before = 0, after = 0;  // sequences
  double certainty = 0.95;
  std::optional<JointComparison> joints = {};
};

std::string compare_report(const ComparedWalks& walks);

/// "surefoot.compare/1"
std::string compare_json(const ComparedWalks& walks);

}  // namespace calibrate_program

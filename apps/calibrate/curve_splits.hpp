// Splits of a learning curve as a file that grows while they are computed, so that stopped work goes on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "surefoot/motion/plan.hpp"

namespace calibrate_program {

/// What the results depend on, as one line: another model, other data or settings give another one.
std::string curve_fingerprint(const surefoot::AnyMotionModel& model, std::span<const surefoot::WalkSequence> sequences,
                              const surefoot::LearningCurveOptions& options, std::uint64_t seed);

/// CSV: the fingerprint, then repetition, count, error and parameters of one fit a row, with all their digits.
class CurveSplits {
 public:
  /// Reads what is there with that fingerprint, and begins the file anew with that; what a program that was killed left
  /// half written is left out.
  CurveSplits(std::filesystem::path file, const std::string& fingerprint, std::vector<std::size_t> counts);

  std::optional<std::vector<surefoot::SplitResult>> known(std::size_t repetition) const;
  void add(std::size_t repetition, const std::vector<surefoot::SplitResult>& result);
  std::size_t size() const { return known_.size(); }

 private:
  std::string rows(std::size_t repetition, const std::vector<surefoot::SplitResult>& result) const;

  std::vector<std::size_t> counts_;
  std::map<std::size_t, std::vector<surefoot::SplitResult>> known_;
  std::ofstream out_;
};

}  // namespace calibrate_program

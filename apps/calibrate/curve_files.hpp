// Learning curves as files and pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model_kind.hpp"
#include "surefoot/motion/plan.hpp"

namespace calibrate_program {

struct CountedCurve {
  ModelKind kind;
  surefoot::LearningCurve curve;
  surefoot::MoreSequences more;
};

/// Which model to use with the sequences at hand, and how many more are worth walking.
std::string which_model(const std::vector<CountedCurve>& curves);

/// curve.csv, curve.json, curve.svg and .png, coefficients.svg and .png (of the full model). `as_commanded`: error of
/// the commands as they are [m]. Throws example::UsageError if gnuplot is missing.
void write_curve_files(const std::filesystem::path& folder, const std::vector<CountedCurve>& curves,
                       double as_commanded, const surefoot::LearningCurveOptions& options);

}  // namespace calibrate_program

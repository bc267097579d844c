// Report of `fit` as text for the terminal.
#pragma once

#include <string>

#include "fit_walk.hpp"

namespace calibrate_program {

std::string fit_report(const FittedWalk& fitted);

/// The table of models and their errors.
std::string evaluation_table(const std::vector<EvaluatedModel>& models);

}  // namespace calibrate_program

// Reliability of stated probabilities: how often what is called 70 % sure is right.
#pragma once

#include <string>
#include <vector>

#include "compare.hpp"

namespace score {

/// A structure that an answer lists, and whether it is the hidden one.
struct Statement {
  double probability = 0;
  bool right = false;
};

/// Statements of similar probability.
struct Bin {
  double low = 0, high = 1;
  double probability = 0, share_right = 0;  // means over its statements
  int count = 0;
};

/// All structures with a probability; of cases outside the library every named one is wrong.
std::vector<Statement> statements_of(const std::vector<Outcome>& outcomes);

/// Bins of equal width; those without a statement are left out.
std::vector<Bin> bins_of(const std::vector<Statement>& statements, int count = 10);

/// Mean distance of stated probability and share right, weighted by statements; NaN without any.
double expected_calibration_error(const std::vector<Bin>& bins);

/// Columns for reliability.gp: mean probability, share right, its standard error, statements.
std::string reliability_data(const std::vector<Bin>& bins);

}  // namespace score

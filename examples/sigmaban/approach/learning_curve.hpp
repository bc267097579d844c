// The learning curves of RFPI as a picture.
#pragma once

#include "results.hpp"

namespace sigmaban {

/// Draws cost against CPU seconds for both problems from the records of their trainings, with the lines of the paper
/// and of the near-optimal solution: learning_curve.svg and .png. Throws UsageError if a record cannot be read.
void draw_learning_curves(const Results& results);

}  // namespace sigmaban

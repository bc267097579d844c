// Comparison of an answer with the truth of a case.
#pragma once

#include <vector>

#include "answer.hpp"

namespace score {

struct Outcome {
  const Truth* truth = nullptr;
  Answer answer;
  bool detected = false;     // says that something is missing
  bool named_first = false;  // its first name is right, or a declared class of indistinguishable ones contains it
  bool named_in_three = false;
  bool all_named = false;                // every hidden effect is among those named
  bool attached = false;                 // of a right name: at the right place
  bool structure_right = false;          // choice, or a declared class, holds exactly what is hidden, places included
  bool against_noise = false;            // called explained, though the held-out error is far above the noise
  int class_size = 1;                    // hypotheses declared indistinguishable, the chosen one included
  int superfluous = 0;                   // names that are not in the truth
  std::vector<double> parameter_errors;  // relative
  double error_ratio = 0;                // held-out error over the true model's; NaN if the answer does not tell
};

/// Held-out error, in those of the true model on the same readings, above which a model explains nothing away.
constexpr double unexplained_error = 1.5;

/// Whether these effects are exactly the hidden ones, each at its place; equivalent descriptions count as the same.
bool is_right_structure(const Truth& truth, const std::vector<Effect>& effects);

Outcome compare(const Truth& truth, const Answer& answer);

/// In words what is wrong; empty if nothing is.
std::string complaint(const Outcome& outcome);

}  // namespace score

// Rates over many cases, and how they are printed.
#pragma once

#include <string>
#include <vector>

#include "compare.hpp"

namespace score {

/// So many of so many.
struct Share {
  int hits = 0, of = 0;
  void add(bool hit) { hits += hit ? 1 : 0, ++of; }
};

/// One method over all cases.
struct Summary {
  std::string method;
  std::size_t done = 0, cases = 0;
  Share false_alarm, detected, named_first, named_in_three, attached, both_named, no_superfluous;
  Share unexplained, misnamed;   // cases outside the library
  Share structure;               // cases with nothing, one or two effects
  Share finished_structure;      // the same, of a search that was finished
  Share against_noise;           // all cases whose held-out error is known
  std::size_t stated = 0;        // probabilities of structures
  double calibration_error = 0;  // expected: of these probabilities, against shares
  Share final_poses;             // walks with final poses only: the four planar effects named first
  double class_size = 0;         // mean over cases with one or two effects
  double parameter_error = 0;    // median, relative
  double error_ratio = 0;        // median
  double seconds = 0, seconds_most = 0;
};

Summary summarize(const std::string& method, const std::vector<Outcome>& outcomes, std::size_t cases);

/// Confusion matrices, rates by effect, and the list of wrong cases.
void print_details(const std::vector<Outcome>& outcomes);

/// One row per line of the requirements, one column per method.
void print_summaries(const std::vector<Summary>& summaries);

}  // namespace score

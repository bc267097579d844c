// Preparation of recordings: screening, cuts where there are few, and initial states that a sensor read.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/verdict/fitted_model.hpp"

namespace surefoot::diagnosis {

struct PreparationCriteria {
  std::size_t enough = 4;       // recordings that are left as they are: with one held out, three to fit
  std::size_t folds = 4;        // of the recordings to fit
  std::size_t parts = 5;        // at least, of all recordings together
  std::size_t fewest = 3;       // parts that are of more use than whole recordings
  Eigen::Index part_rows = 20;  // least rows of a part
  double lead_in = 0.25;        // of a part: rows before it, simulated and not compared (effects forget their start)
  double initial_share = 0.2;   // of a state's root mean square: by how much it may be off at a cut
  double least_initial = 1e-6;  // the same in units of the model, for a state that is always 0
};

/// Cuts few recordings into parts, so that some can be held out. A part begins a little earlier, at rows without
/// readings: hidden states of effects are at rest there, and forget it on the way. Its states are those of the
/// calibrated simulation, to be estimated from there on; where an output reads a state it starts from the measurement.
std::vector<Recording> cut_recordings(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                      const std::vector<SimulatedRun>& trajectories, std::size_t parts,
                                      const PreparationCriteria& criteria = {});

/// Recording r as parts that begin at row 0 and at these rows, from what was measured there; other states are these
/// (state x row), to be estimated from there on.
std::vector<Recording> cut_at_rows(const BoundSimulator& bound, std::size_t r, const Eigen::MatrixXd& states,
                                   const std::vector<std::size_t>& rows, const PreparationCriteria& criteria = {});

/// Puts recordings in the order of their names, those of one name in that of their times and inputs: what is concluded
/// does not depend on the order in which they are given.
void sort_recordings(std::vector<Recording>& recordings);

/// Of more rows than `most` each recording keeps only the first ones, short recordings all of theirs. Returns how many
/// rows the longest has left, 0 if none was shortened.
Eigen::Index shorten_recordings(std::vector<Recording>& recordings, std::size_t most);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/prepare.ipp"
#endif

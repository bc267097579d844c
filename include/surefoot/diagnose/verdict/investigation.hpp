// An investigation under way: what the stages of a diagnosis hand on to each other.
#pragma once

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/estimation/data_split.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/selection/search.hpp"
#include "surefoot/diagnose/simulation/bound_simulator.hpp"

namespace surefoot::diagnosis {

/// A diagnosis with everything it was drawn from.
struct Investigation {
  Diagnosis diagnosis;
  BoundSimulator bound;
  RecordingSplit split;
  SearchProblem problem;
  NoiseKind noise = NoiseKind::measurement;
  Hypothesis nominal;
  Comparison parameters_matter;  // nominal against calibrated
  Selection selection;
};

}  // namespace surefoot::diagnosis

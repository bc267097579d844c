// An investigation under way: what the stages of a diagnosis hand on to each other.
#pragma once

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/process_noise.hpp"
#include "surefoot/diagnose/rig.hpp"
#include "surefoot/diagnose/select.hpp"
#include "surefoot/diagnose/split.hpp"

namespace surefoot {

/// A diagnosis with everything it was drawn from.
struct Investigation {
  Diagnosis diagnosis;
  Rig rig;
  RecordingSplit split;
  SelectProblem problem;
  NoiseKind noise = NoiseKind::measurement;
  Hypothesis nominal;
  Comparison parameters_matter;  // nominal against calibrated
  Selection selection;
};

}  // namespace surefoot

// A first guess of a state that is not known at the beginning of a recording.
#pragma once

#include "layout.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {

struct StartGuess {
  double value = 0, scale = 1;  // scale: how far it may be off, above 0
};

/// From the output that measures the state, else from the first differences of the one that measures what the state is
/// the speed of, else from an output, or a state that is read, in the same unit; else 0.
StartGuess guess_start(const surefoot::Recording& recording, const StateStart& start);

}  // namespace diagnose_program

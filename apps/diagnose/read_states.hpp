// Which output of a model file reads a state, perhaps in another unit or from another zero.
#pragma once

#include <cstddef>

#include "layout.hpp"
#include "model_file.hpp"

namespace diagnose_program {

/// The first output that is a number plus a factor times this state, whatever all else is; the state as it is before
/// others. Cost: some evaluations by output.
ReadState read_state(const ModelFile& model, std::size_t state);

}  // namespace diagnose_program

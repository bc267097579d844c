// The augmented model as a C++ header for the library: a simulator, and the values that were found.
#pragma once

#include <string>

#include "model_file.hpp"
#include "surefoot/diagnose/diagnosis.hpp"

namespace diagnose_program {

/// Text of a header with `augmented::Model`, a surefoot::Simulator, and `augmented::found()`, its calibrated parameters
/// and effects, for surefoot::simulate_augmented(). `model` is augmented_model().
std::string model_header(const ModelFile& model, const surefoot::Diagnosis& diagnosis);

}  // namespace diagnose_program

// The model file with what was found: calibrated parameters and a table [[effects]]. The program itself reads it back.
#pragma once

#include <string>

#include "model_file.hpp"
#include "surefoot/diagnose/diagnosis.hpp"

namespace diagnose_program {

/// The model as text, in the order of its tables.
std::string model_text(const ModelFile& model);

/// The same with the calibrated parameters, and the effects that were found after those it had.
ModelFile augmented_model(const ModelFile& model, const surefoot::Diagnosis& diagnosis);

}  // namespace diagnose_program

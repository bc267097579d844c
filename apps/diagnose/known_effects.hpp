// The effects that a model file has already, as the library knows them.
#pragma once

#include <string>
#include <vector>

#include "model_file.hpp"
#include "surefoot/diagnose/effects/named_effect.hpp"

namespace diagnose_program {

/// Names of effects, each once, whatever their forms.
std::vector<std::string> names_of_effects(const std::vector<surefoot::Effect>& library);

/// In the order of the file; values in the order of the effect's parameters. Throws surefoot::DiagnoseError for names
/// that the library does not know and for parameters that are missing.
std::vector<surefoot::NamedEffect> known_effects(const ModelFile& model, const std::vector<surefoot::Effect>& library);

}  // namespace diagnose_program

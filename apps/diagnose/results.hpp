// The files that a diagnosis leaves in its folder.
#pragma once

#include <filesystem>

#include "model_file.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace diagnose_program {

/// Makes the folder, and throws surefoot::DiagnoseError if no file can be written there: better now than after the
/// work.
void prepare_folder(const std::filesystem::path& folder);

/// diagnosis.json, report.html with its pictures, with a model file augmented.toml and augmented.hpp, and the residual
/// forest where one is kept.
void write_results(const surefoot::Diagnosis& diagnosis, const surefoot::SimulatorInfo& info,
                   const std::filesystem::path& folder, const ModelFile* model);

void print_summary(const surefoot::Diagnosis& diagnosis, const std::filesystem::path& folder);

}  // namespace diagnose_program

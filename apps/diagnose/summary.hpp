// The result in about fifteen lines for a terminal.
#pragma once

#include <filesystem>
#include <string>

#include "surefoot/diagnose/diagnosis.hpp"

namespace diagnose_program {

std::string summary(const surefoot::Diagnosis& diagnosis, const std::filesystem::path& out);

}  // namespace diagnose_program

// The 15 parameters of Winner2016 as a JSON file: what `tune` writes and `evaluate --policy` reads.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "winner2016.hpp"

namespace sigmaban {

/// The parameters by name.
nlohmann::ordered_json to_json(const Winner2016Parameters& parameters);

/// Reads {"policy": "winner2016", "parameters": {name: number, ...}, ...}; every parameter must be there once.
/// Throws UsageError naming the file and the field.
Winner2016Parameters read_parameters(const std::filesystem::path& path);

}  // namespace sigmaban

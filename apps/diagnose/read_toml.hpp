// The TOML of a file as a tree of values; what is no TOML is refused in one sentence.
#pragma once

#include <string>
#include <string_view>
#include <toml.hpp>

namespace diagnose_program {

/// Throws DiagnoseError that names the file, and line and column where they are known.
toml::value read_toml(std::string_view text, const std::string& file);

}  // namespace diagnose_program

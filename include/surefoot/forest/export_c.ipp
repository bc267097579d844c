// Definitions of surefoot/forest/export_c.hpp.
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/c/c_writer.hpp"
#include "surefoot/forest/export_c.hpp"

namespace surefoot {

SUREFOOT_INLINE void check(const ExportCOptions& options, int outputs) {
  const std::string& name = options.function;
  const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), letter) ||
      std::isdigit(static_cast<unsigned char>(name[0])) != 0) {
    throw ForestError("ExportCOptions: function must be a name in C, got \"" + name + "\"");
  }
  const auto count = static_cast<std::size_t>(outputs);
  bool right = options.low.size() == options.high.size() && (options.low.empty() || options.low.size() == count);
  for (std::size_t i = 0; right && i < options.low.size(); ++i) {
    right = std::isfinite(options.low[i]) && std::isfinite(options.high[i]) && options.low[i] <= options.high[i];
  }
  if (!right) {
    throw ForestError("ExportCOptions: low and high must be empty or hold " + std::to_string(count) +
                      " finite numbers each, one per output, low not above high");
  }
}

SUREFOOT_INLINE std::string detail::c_file(const Trees& trees, std::uint32_t leaf_tag, const std::string& leaf_code,
                                           const ExportCOptions& options) {
  if (trees.roots.empty()) throw ForestError("export_c: the forest is empty, train or load it first");
  check(options, trees.outputs);
  return CWriter(trees, leaf_tag, leaf_code, options).code();
}

}  // namespace surefoot

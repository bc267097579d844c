// Definitions of surefoot/forest/export_c.hpp.
#pragma once

#include <cstdint>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/c/c_writer.hpp"
#include "surefoot/forest/export_c.hpp"

namespace surefoot {

SUREFOOT_ONCE std::string detail::c_file(const Trees& trees, std::uint32_t leaf_tag, const std::string& leaf_code,
                                         const ExportCOptions& options) {
  if (trees.roots.empty()) throw ForestError("export_c: the forest is empty, train or load it first");
  check(options, trees.outputs);
  return CWriter(trees, leaf_tag, leaf_code, options).code();
}

}  // namespace surefoot

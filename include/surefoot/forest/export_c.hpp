// A forest as one C99 file without dependencies, for a micro-controller: tables of 32-bit numbers and a few lines of
// code, or nested ifs, that give the same outputs as Forest::predict. No allocation, no recursion, no libm.
//
// Size: per node (of which there are two per leaf) tables have one small integer and one number, its threshold or what
// its leaf says, and per leaf its numbers if there are several: about 25 characters for the two nodes of a leaf and 11
// (or 5, see CTable) for each of its numbers; in the machine 1 to 4 + 4 bytes a node (+ 2 with 16-bit thresholds), and
// 4 (5) bytes a number. Nested ifs take several times that.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/export_c_options.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot {

/// A leaf model that knows how to write itself in C.
template <class L>
concept CLeafModel = LeafModel<L> && requires {
  { L::c_code(1, 1) } -> std::same_as<std::string>;
};

namespace detail {

std::string c_file(const Trees& trees, std::uint32_t leaf_tag, const std::string& leaf_code,
                   const ExportCOptions& options);

}  // namespace detail

/// The C file's text. Its function rounds the inputs to float, as predict does, and then does the same sums in the same
/// order: with IEEE doubles the outputs are equal to the last bit. With whole numbers (see CThreshold) that holds for
/// inputs farther than 1 / scale from all thresholds, linear leaves being taken at the rounded input.
template <int Inputs, int Outputs, CLeafModel Leaf>
std::string export_c(const Forest<Inputs, Outputs, Leaf>& forest, const ExportCOptions& options = {}) {
  return detail::c_file(forest.raw(), Leaf::tag, Leaf::c_code(forest.inputs(), forest.outputs()), options);
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/export_c.ipp"
#endif

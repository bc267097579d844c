// A forest as one C99 file without dependencies, for a micro-controller: tables of 32-bit numbers and a few lines of
// code, or nested ifs, that give the same outputs as Forest::predict. No allocation, no recursion, no libm.
//
// Size: per inner node tables have one small integer and one threshold, per leaf its numbers: about 14 characters for
// each inner node and 10 (or 5, see CTable) for each of a leaf's numbers; in the machine 2 or 4 + 4 bytes (4 + 2 with
// 16-bit thresholds), and 4 (5) bytes. Nested ifs take several times that per inner node.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/evaluate/trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"

namespace surefoot {

/// How a C file spells its tables of numbers.
enum class CTable {
  integers,  // hexadecimal integers of 64 bits: no decoding, fastest
  text,      // five characters per number in string literals: half the source, decoded at every use
};

/// In what kind of numbers a C file compares inputs with thresholds.
enum class CThreshold {
  float32,  // as in the library: the same leaves always
  int32,    // whole numbers, each input multiplied by a power of two (see c/c_fixed_point.hpp)
  int16,
};

/// How a C file finds a leaf.
enum class CDescent {
  tables,    // a loop over tables: small
  branches,  // nested ifs: fast for trees that fit into the caches, at most 120 levels deep
};

struct ExportCOptions {
  std::string function = "surefoot_forest";  // void FUNCTION(const double in[inputs], double out[outputs])
  CTable table = CTable::integers;
  std::string wrapper = {};  // C code put behind the function, to call it: features before, units after; the
                             // function is then static
  CDescent descent = CDescent::tables;
  // int32, int16: void FUNCTION(const intN_t in[inputs], double out[outputs]), and intN_t FUNCTION_input(int input,
  // double value) that scales and rounds a value to what `in` wants. The file's head states the scales.
  CThreshold thresholds = CThreshold::float32;
  std::vector<double> largest_inputs = {};  // whole numbers: sizes up to which inputs are told apart; empty: up to the
                                            // thresholds' (linear leaves may need more)
  std::vector<double> low = {}, high = {};  // bounds that each output is kept in; empty: outputs as the forest has them
};

/// A leaf model that knows how to write itself in C.
template <class L>
concept CLeafModel = LeafModel<L> && requires {
  { L::c_code(1, 1) } -> std::same_as<std::string>;
};

/// Throws a ForestError that names the field and the cure. `outputs`: of the forest.
void check(const ExportCOptions& options, int outputs);

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

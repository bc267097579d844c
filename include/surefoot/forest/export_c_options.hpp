// Options of `export_c()`.
#pragma once

#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"

namespace surefoot {

/// How a C file spells its tables of numbers.
enum class CTable {
  integers,  // hexadecimal integers: no decoding, fastest
  text,      // five characters per number in string literals (short ones: three): half the source, decoded at every use
};

/// In what kind of numbers a C file compares inputs with thresholds.
enum class CThreshold {
  float32,  // as in the library: the same leaves always
  int32,    // whole numbers, each input multiplied by a power of two (see c/c_fixed_point.hpp)
  int16,
};

/// How a C file finds a leaf.
enum class CDescent {
  tables,    // a loop over tables, four trees at a time: small, and about as fast as the library
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
  bool whole_outputs = false;  // with whole thresholds and tables, constant and clamped linear leaves: no floating
                               // point at all, void FUNCTION(const intN_t in[inputs], int32_t out[outputs]), and double
                               // FUNCTION_output(int output, int32_t value) that says what `out` means
  std::vector<double> agreement =
      {};  // per output: trees that differ by more are of different opinions, and the output
           // is the mean of the largest group around the medoid; empty: the mean of all
  std::vector<double> low = {}, high = {};  // bounds that each output is kept in; empty: outputs as the forest has them
};

/// Throws a ForestError that names the field and the cure. `outputs`: of the forest.
void check(const ExportCOptions& options, int outputs);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/export_c_options.ipp"
#endif

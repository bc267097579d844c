// Definitions of surefoot/forest/fraction_of_variance_unexplained.hpp.
#pragma once

#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/fraction_of_variance_unexplained.hpp"

namespace surefoot::detail {

SUREFOOT_ONCE void check_fit(const TreesShape& forest, bool empty, const DatasetView& samples, const char* who) {
  if (empty) throw ForestError(std::string(who) + ": the forest is empty, train or load it first");
  if (samples.input_rows != forest.inputs || samples.output_rows != forest.outputs) {
    throw ForestError(std::string(who) + ": the samples have " + std::to_string(samples.input_rows) + " inputs and " +
                      std::to_string(samples.output_rows) + " outputs, but the forest " +
                      std::to_string(forest.inputs) + " and " + std::to_string(forest.outputs));
  }
}

}  // namespace surefoot::detail

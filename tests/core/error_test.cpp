#include "surefoot/core/error.hpp"

#include <doctest/doctest.h>

#include <string>

namespace surefoot {
namespace {

TEST_CASE_TEMPLATE("every error of an area is caught as an Error and keeps its sentence", E, CoreError, ForestError,
                   OptimizeError, MotionError, SolveError, DiagnoseError) {
  try {
    throw E("runs must be at least 1");
  } catch (const Error& error) {
    CHECK(std::string(error.what()) == "runs must be at least 1");
  }
}

}  // namespace
}  // namespace surefoot

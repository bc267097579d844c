#include "surefoot/forest/export_c_options.hpp"

#include <doctest/doctest.h>

#include "surefoot/core/error.hpp"

namespace surefoot {
namespace {

TEST_CASE("a function without a name in C, and bounds that do not fit the outputs, are named") {
  CHECK_NOTHROW(check(ExportCOptions{}, 2));
  for (const char* name : {"", "7up", "a-b"}) {
    ExportCOptions options;
    options.function = name;
    CHECK_THROWS_WITH_AS(check(options, 2), doctest::Contains("must be a name in C"), ForestError);
  }
  ExportCOptions options;
  options.low = {-1, -1};
  options.high = {1, 1};
  CHECK_NOTHROW(check(options, 2));
  CHECK_THROWS_WITH_AS(check(options, 3), doctest::Contains("low and high"), ForestError);
  options.high = {1, -2};
  CHECK_THROWS_WITH_AS(check(options, 2), doctest::Contains("low not above high"), ForestError);
}

}  // namespace
}  // namespace surefoot

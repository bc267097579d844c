// Numbers and effects in words.
#include "surefoot/diagnose/text.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace surefoot {
namespace {

TEST_CASE("numbers have three significant digits, whatever their size") {
  CHECK(in_digits(0.123456) == "0.123");
  CHECK(in_digits(-12.345) == "-12.3");
  CHECK(in_digits(2) == "2");
  CHECK(in_digits(0) == "0");
  CHECK(in_digits(1.2345e-7) == "1.23e-07");
}

TEST_CASE("a unit follows its number, none where there is none") {
  CHECK(with_unit(0.15, "N m") == "0.15 N m");
  CHECK(with_unit(0.15, "1") == "0.15");
  CHECK(with_unit(0.15, "") == "0.15");
}

TEST_CASE("sentences are filled wherever a name stands between braces, as often as it does") {
  const std::vector<FittedValue> values{{"level", "N m", 0.15}, {"speed", "rad/s", 2}};
  CHECK(fill_sentence("{at}: {level} at {speed}, not {level}", "omega", values) ==
        "omega: 0.15 N m at 2 rad/s, not 0.15 N m");
  CHECK(fill_sentence("nothing to fill in", "omega", values) == "nothing to fill in");
  CHECK(fill_sentence("{unknown} stays", "omega", values) == "{unknown} stays");
}

TEST_CASE("a value that is hardly known is told with its interval, one that is known without") {
  const FittedValue known{"level", "N m", 0.15, 0.14, 0.16}, doubtful{"level", "N m", 0.15, 0.02, 0.9};
  CHECK(fill_sentence("{level} of friction", "omega", {known}) == "0.15 N m of friction");
  CHECK(fill_sentence("{level} of friction", "omega", {doubtful}) == "0.15 N m (0.02 to 0.9) of friction");
}

TEST_CASE("lists end with an and") {
  CHECK(in_list({}).empty());
  CHECK(in_list({"a"}) == "a");
  CHECK(in_list({"a", "b"}) == "a and b");
  CHECK(in_list({"a", "b", "c"}) == "a, b and c");
}

}  // namespace
}  // namespace surefoot

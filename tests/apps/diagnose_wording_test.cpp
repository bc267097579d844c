#include <doctest/doctest.h>

#include "apps/diagnose/wording.hpp"

TEST_CASE("shares are printed without exponents") {
  using diagnose_program::percent;
  CHECK(percent(0.0961) == "9.6 %");
  CHECK(percent(0.094) == "9 %");
  CHECK(percent(0.9961) == "99.6 %");
  CHECK(percent(0.99) == "99 %");
  CHECK(percent(0.998) == "99.8 %");
  CHECK(percent(1) == "100 %");
  CHECK(percent(1.234) == "123 %");
}

#include <doctest/doctest.h>

#include "apps/diagnose/wording.hpp"

TEST_CASE("a fault of the log is said with its cure, or that it was repaired") {
  surefoot::LogFault fault{.kind = "sign_flipped"};
  fault.sentence = "a.csv: y has the opposite sign";
  fault.cure = "flip its sign";
  CHECK(diagnose_program::fault_text(fault) ==
        "a.csv: y has the opposite sign; flip its sign, or run again with --repair");
  fault.repaired = true;
  CHECK(diagnose_program::fault_text(fault) == "a.csv: y has the opposite sign (repaired for this diagnosis)");
  CHECK(diagnose_program::fault_text({.kind = "odd_recording", .sentence = "a", .cure = "b"}) ==
        "a; b, as --repair does");
  CHECK(diagnose_program::fault_text({.kind = "odd_recording", .sentence = "a", .cure = "b", .repaired = true}) ==
        "a (left out of this diagnosis)");
}

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

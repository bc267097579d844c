// Recordings as CSV text.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "apps/diagnose/csv.hpp"
#include "surefoot/diagnose/recording.hpp"

using diagnose_program::numbers;
using diagnose_program::parse_csv;

namespace {

void check_csv_refused(const std::string& text, const std::string& words) {
  CAPTURE(text);
  try {
    parse_csv(text, "rec.csv");
    FAIL("not refused");
  } catch (const surefoot::DiagnoseError& error) {
    const std::string what = error.what();
    CAPTURE(what);
    CHECK(what.find("rec.csv") == 0);
    CHECK(what.find(words) != std::string::npos);
    CHECK(what.find('\n') == std::string::npos);
  }
}

}  // namespace

TEST_CASE("a CSV file has constants, a header and numbers, and may miss cells") {
  const auto csv = parse_csv("# mass_kg: 0.5\r\n# who: me\r\n\r\nt_s,a_V\r\n0, 1e-3 \r\n+1,\r\n2,nan\r\n", "rec.csv");
  CHECK(csv.meta.at("mass_kg") == "0.5");
  CHECK(csv.meta.at("who") == "me");
  REQUIRE(csv.rows() == 3);
  CHECK(numbers(csv, "t_s", "")[1] == 1);
  CHECK(numbers(csv, "a_V", "")[0] == 1e-3);
  CHECK(std::isnan(numbers(csv, "a_V", "")[1]));
  CHECK(std::isnan(numbers(csv, "a_V", "")[2]));
  CHECK(csv.lines[2] == 7);
}

TEST_CASE("semicolons or tabs between cells are refused with the cure") {
  check_csv_refused("t_s;a_V\n0,0;1,5\n", "line 1: cells are set apart by semicolons; save it with commas");
  check_csv_refused("# who: me\nt_s\ta_V\n0\t1\n", "line 2: cells are set apart by tabs; save it with commas");
}

TEST_CASE("a mark of UTF-8 before the header is no part of it") {
  CHECK(parse_csv("\xEF\xBB\xBFt_s\n1\n", "rec.csv").columns[0].name == "t_s");
}

TEST_CASE("a text column is an error only if it is read") {
  const auto csv = parse_csv("t_s,note\n0,slow\n", "rec.csv");
  CHECK(numbers(csv, "t_s", "").size() == 1);
  CHECK_THROWS_WITH_AS(
      numbers(csv, "note", ""),
      "rec.csv, line 2: column 'note' holds \"slow\", which is no finite number; leave a cell empty where "
      "nothing was measured",
      surefoot::DiagnoseError);
}

TEST_CASE("a missing column is named, with those that are there and what it is for") {
  const auto csv = parse_csv("t_s,a_V\n0,1\n", "rec.csv");
  CHECK_THROWS_WITH_AS(numbers(csv, "b_V", "which the model reads as an input"),
                       "rec.csv: column 'b_V' is missing, which the model reads as an input; the file has t_s, a_V",
                       surefoot::DiagnoseError);
}

TEST_CASE("wrong CSV files are refused in one sentence") {
  check_csv_refused("", "the file is empty");
  check_csv_refused("# mass: 1\n\n", "the file is empty");
  check_csv_refused("t_s,a_V\n0,1\n1\n", "line 3: the row has 1 cells, but the header has 2");
  check_csv_refused("t_s,a_V\n0,1,2\n", "line 2: the row has 3 cells, but the header has 2");
  check_csv_refused("t_s,,a_V\n0,1,2\n", "line 1: column 2 has no name");
  check_csv_refused("t_s,t_s\n0,1\n", "line 1: column 't_s' stands twice");
  check_csv_refused("0,1\n1,2\n", "line 1: there is no header row");
}

TEST_CASE("numbers that are not finite are no numbers") {
  const auto csv = parse_csv("t_s\ninf\n", "rec.csv");
  CHECK_THROWS_AS(numbers(csv, "t_s", ""), surefoot::DiagnoseError);
  const auto huge = parse_csv("t_s\n1e999\n", "rec.csv");
  CHECK_THROWS_AS(numbers(huge, "t_s", ""), surefoot::DiagnoseError);
}

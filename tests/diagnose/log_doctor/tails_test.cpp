#include "surefoot/diagnose/log_doctor/tails.hpp"

#include <doctest/doctest.h>

namespace {

using surefoot::diagnosis::f_tail;
using surefoot::diagnosis::t_tail;

TEST_SUITE("log_doctor") {
  TEST_CASE("tails of t and F are those of the tables") {
    CHECK(t_tail(2.228, 10) == doctest::Approx(0.05).epsilon(1e-3));
    CHECK(t_tail(-4.587, 10) == doctest::Approx(0.001).epsilon(1e-3));
    CHECK(f_tail(3.3258, 5, 10) == doctest::Approx(0.05).epsilon(1e-3));
    CHECK(f_tail(1, 1, 1) == doctest::Approx(0.5));
  }

  TEST_CASE("nothing to compare is no evidence, and infinitely far is all") {
    CHECK(f_tail(3, 0, 5) == 1);
    CHECK(f_tail(0, 3, 5) == 1);
    CHECK(f_tail(INFINITY, 3, 5) == 0);
  }
}

}  // namespace

// Damaged model files and recordings. diagnose_mutations_main.cpp does the same for as long as one likes.
#include "tests/apps/diagnose_mutations.hpp"

#include <doctest/doctest.h>

using namespace diagnose_test;

TEST_CASE("five thousand damaged model files are read or refused in one sentence") {
  surefoot::Rng rng(11);
  MutationCounts counts;
  for (int i = 0; i < 5000; ++i) try_model(damaged(i % 2 == 0 ? servo_model : walk_model, rng), counts);
  CAPTURE(counts.bad_message);
  CHECK(counts.bad_messages == 0);
  CHECK(counts.read > 100);
  CHECK(counts.refused > 2000);
}

TEST_CASE("five thousand damaged recordings are read or refused in one sentence") {
  surefoot::Rng rng(12);
  MutationCounts counts;
  const auto layout = diagnose_program::layout_of(diagnose_program::parse_model_file(servo_model, "servo.toml"));
  for (int i = 0; i < 5000; ++i) try_recording(damaged(servo_csv, rng), layout, counts);
  CAPTURE(counts.bad_message);
  CHECK(counts.bad_messages == 0);
  CHECK(counts.read > 100);
  CHECK(counts.refused > 2000);
}

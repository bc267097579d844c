// A model that was read computes, and is written as a file that is read again.
#include "tests/apps/diagnose_mutations.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/text_of.hpp"

void fuzz::model(Input input) {
  diagnose_test::MutationCounts counts;
  diagnose_test::try_model(text_of(input), counts);
  require(counts.bad_messages == 0, "a message that is no clear sentence: " + counts.bad_message);
}

// Recordings that were read have finite times, inputs and starts, whatever the model wants of them.
#include <array>

#include "tests/apps/diagnose_models.hpp"
#include "tests/apps/diagnose_mutations.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/text_of.hpp"

namespace {

using diagnose_program::Layout;

Layout layout(const std::string& model) {
  return diagnose_program::layout_of(diagnose_program::parse_model_file(model, "model.toml"));
}

/// Of a machine that moves in time, of a walk of many sequences, and of a machine whose start must be guessed.
const std::array<Layout, 3>& layouts() {
  using namespace diagnose_test;
  static const std::string guessed = with(with(servo_model, "initial = \"column:theta_rad\"", "initial = \"free\""),
                                          "initial = \"0\"", "initial = \"free\"");
  static const std::array<Layout, 3> all{layout(servo_model), layout(walk_model),
                                         layout(with(guessed, "time   = \"t_s\"", "time   = \"t_s\"\nskip_rows = 1"))};
  return all;
}

}  // namespace

void fuzz::recording(Input input) {
  for (const Layout& layout : layouts()) {
    diagnose_test::MutationCounts counts;
    diagnose_test::try_recording(text_of(input), layout, counts);
    require(counts.bad_messages == 0, "a recording or a message that is none: " + counts.bad_message);
  }
}

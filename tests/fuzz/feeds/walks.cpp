// Walks that were read are sound, in every layout that a file can have.
#include <vector>

#include "apps/calibrate/load_sequences.hpp"
#include "surefoot/diagnose/recording.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/text_of.hpp"

namespace {

using namespace calibrate_program;

std::vector<LoadOptions> every_way() {
  LoadOptions named;
  named.columns.commands = {"a_cm", "b_m", "c_deg"};
  named.columns.pose = {"x_m", "y_m"};
  LoadOptions wheels;
  wheels.columns.wheels = {"v_left_m_s", "v_right_m_s"};
  wheels.wheel_base = 0.2;
  LoadOptions commands_only;
  commands_only.poses_needed = false;
  LoadOptions final_only;
  final_only.final_only = true;
  return {{}, named, wheels, commands_only, final_only};
}

}  // namespace

void fuzz::walks(Input input) {
  static const std::vector<LoadOptions> ways = every_way();
  for (const LoadOptions& options : ways) {
    accepted<surefoot::MotionError, surefoot::DiagnoseError>([&] {
      const auto loaded = sequences_of(diagnose_program::parse_csv(text_of(input), "walk.csv"), options);
      if (options.poses_needed && !loaded.sequences.empty()) {
        check(std::span<const surefoot::WalkSequence>(loaded.sequences));
      }
    });
  }
}

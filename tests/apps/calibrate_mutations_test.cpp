// Damaged recordings, sheets and motion files.
#include <doctest/doctest.h>

#include "apps/calibrate/load_sequences.hpp"
#include "apps/calibrate/sheet.hpp"
#include "tests/apps/calibrate_walks.hpp"
#include "tests/apps/diagnose_mutations.hpp"

using namespace calibrate_program;
using diagnose_test::damaged;
using diagnose_test::MutationCounts;

namespace {

template <class Work>
MutationCounts try_damaged(const std::string& text, int count, std::uint64_t seed, Work&& work) {
  surefoot::Rng rng(seed);
  MutationCounts counts;
  for (int i = 0; i < count; ++i) {
    try {
      work(damaged(text, rng));
      ++counts.read;
    } catch (const surefoot::Error& error) {
      diagnose_test::count_message(error.what(), counts);
    }
  }
  return counts;
}

void check_counts(const MutationCounts& counts) {
  CAPTURE(counts.bad_message);
  CHECK(counts.bad_messages == 0);
  CHECK(counts.read > 100);
  CHECK(counts.refused > 500);
}

void load_soundly(const std::string& text, const LoadOptions& options) {
  const auto loaded = sequences_of(diagnose_program::parse_csv(text, "walk.csv"), options);
  if (!loaded.sequences.empty()) check(std::span<const surefoot::WalkSequence>(loaded.sequences));
}

}  // namespace

TEST_CASE("ten thousand damaged recordings are read or refused in one sentence") {
  const auto walks = calibrate_test::paper_walks(3, 3, true);
  check_counts(try_damaged(walks_csv(walks, 2), 6000, 21, [](const std::string& text) { load_soundly(text, {}); }));
  LoadOptions wheels;
  wheels.columns.wheels = {"v_left_m_s", "v_right_m_s"};
  wheels.wheel_base = 0.2;
  const std::string wheeled =
      "t_s,v_left_m_s,v_right_m_s,x_m,y_m,yaw_rad\n0,0.1,0.3,1,2,3\n0.5,0.2,0.2,,,\n1.5,0,0,1,1,0\n";
  check_counts(try_damaged(wheeled, 4000, 22, [&](const std::string& text) { load_soundly(text, wheels); }));
}

TEST_CASE("two thousand damaged sheets are merged or refused in one sentence") {
  const std::string commands = commands_csv(surefoot::plan_commands(surefoot::CommandBounds(), 3, 2, 1), 1);
  const auto parsed = diagnose_program::parse_csv(commands, "commands.csv");
  check_counts(try_damaged("seq,x_cm,y_cm,heading_clock\n1,100,-20,3\n2,,,\n3,50,10,12\n", 2000, 23,
                           [&](const std::string& text) {
                             const auto merged = merge_sheet(parsed, diagnose_program::parse_csv(text, "sheet.csv"));
                             load_soundly(merged.walks, {});
                           }));
}

TEST_CASE("ten thousand damaged motion files are read or refused in one sentence") {
  check_counts(try_damaged(motion_file_text(calibrate_test::rich_file()), 10'000, 24, [](const std::string& text) {
    const MotionFile file = parse_motion_file(text, "motion.json");
    parse_motion_file(motion_file_text(file), "again.json");
  }));
}

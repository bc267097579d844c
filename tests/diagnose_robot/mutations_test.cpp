// Damaged models and setups of robots: a robot that can be simulated, or one clear sentence.
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>

#include "apps/diagnose/robot/simulate_robot.hpp"
#include "tests/apps/diagnose_mutations.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using diagnose_test::MutationCounts;
using robot_test::ScratchFolder;
using robot_test::write_text;

namespace {

// Half as many of each kind; SUREFOOT_MUTATIONS=10000 in the environment for a longer run, another seed with every
// number.
long mutations() {
  const char* asked = std::getenv("SUREFOOT_MUTATIONS");
  return asked == nullptr ? 1000 : std::atol(asked);
}

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

void try_robot(const ScratchFolder& folder, const diagnose_program::Csv& csv, MutationCounts& counts) {
  try {
    const Robot robot = robot_test::load(folder);
    constexpr std::size_t rows = 60;
    const RobotRecording recording = read_recording(csv, robot.setup, rows);
    check_recording(robot, recording);
    simulate_robot(robot, recording, start_of(smooth(recording)), robot.nominal);
    ++counts.read;
  } catch (const surefoot::Error& error) {
    diagnose_test::count_message(error.what(), counts);
  }
}

}  // namespace

TEST_CASE("damaged models and setups of robots are read or refused in one sentence") {
  const ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 21, 1);
  const std::string model = text_of(folder.file("robot.xml")), setup = text_of(folder.file("robot.toml"));
  const diagnose_program::Csv csv = diagnose_program::read_csv(folder.file("rec_1.csv"));
  surefoot::Rng rng(static_cast<std::uint64_t>(mutations()));
  MutationCounts models, setups;
  for (long i = 0; i < mutations() / 2; ++i) {
    write_text(folder.file("robot.xml"), diagnose_test::damaged(model, rng));
    try_robot(folder, csv, models);
    write_text(folder.file("robot.xml"), model);
    write_text(folder.file("robot.toml"), diagnose_test::damaged(setup, rng));
    try_robot(folder, csv, setups);
    write_text(folder.file("robot.toml"), setup);
  }
  CAPTURE(models.bad_message);
  CAPTURE(setups.bad_message);
  CHECK(models.bad_messages == 0);
  CHECK(setups.bad_messages == 0);
  CHECK(models.read > mutations() / 40);
  CHECK(models.refused > mutations() / 20);
  CHECK(setups.read > mutations() / 200);  // most changes spoil a name or a number
  CHECK(setups.refused > mutations() / 20);
}

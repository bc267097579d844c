// The paper's experiment on the twin: its starts, its file, its means, and single approaches.
#include <doctest/doctest.h>

#include <cmath>

#include "examples/sigmaban/approach/winner2016.hpp"
#include "examples/sigmaban/twin/table4.hpp"

using namespace sigmaban;

TEST_CASE("twelve starts: two distances, three directions, two kick targets") {
  const auto starts = table4_starts();
  int far = 0, behind = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const double distance = std::hypot(starts[i].x, starts[i].y);
    far += distance > 0.9 ? 1 : 0;
    behind += std::abs(starts[i].angle) > 3 ? 1 : 0;
    CHECK((doctest::Approx(distance) == 0.5 || doctest::Approx(distance) == 1.0));
    for (std::size_t j = 0; j < i; ++j) CHECK((starts[i].vec() - starts[j].vec()).norm() > 0.1);
  }
  CHECK(far == 6);
  CHECK(behind == 6);
}

TEST_CASE("approaches in a file are kept, missing and unfinished ones are walked") {
  const Table4Row row{"anha", "CMA-ES", 7, 1, {.seconds = 12.5 / 3, .reached = true}};
  const std::string csv = table4_header + to_csv(row) + "ha,RFPI,3,0,9.1,1,0";  // killed while it wrote
  const auto all = table4_approaches(csv, 2);
  REQUIRE(all.done.size() == 1);
  CHECK(all.done[0].same_place(row));
  CHECK(all.done[0].approach.seconds == 12.5 / 3);
  CHECK(all.done[0].approach.reached);
  CHECK_FALSE(all.done[0].approach.fell);
  CHECK(all.missing.size() == 2 * 3 * 12 * 2 - 1);
  CHECK(all.missing.front().run == 0);
  CHECK(all.missing.back().run == 1);
  CHECK(table4_approaches(csv, 1).done.empty());
}

TEST_CASE("bounds of a mean come from the scatter at each start, not from that between starts") {
  std::vector<Table4Row> rows;
  for (int start = 0; start < 12; ++start) {
    for (int run = 0; run < 4; ++run) {
      const double seconds = 10.0 * start + (run % 2 == 0 ? 1 : -1);
      rows.push_back({"ha", "RFPI", start, run, {.seconds = seconds, .reached = start > 0 || run > 0}});
    }
  }
  const Table4Cell cell = table4_cell(rows, "ha", "RFPI");
  CHECK(cell.seconds == doctest::Approx(55));
  CHECK(cell.half_width == doctest::Approx(1.96 * std::sqrt(4.0 / 3 / 4 / 12)));
  CHECK(cell.reached == 11);
  CHECK(cell.failed == 1);
  CHECK(cell.runs == 48);
  CHECK(table4_cell(rows, "anha", "RFPI").runs == 0);
}

TEST_CASE("the tuned expert walks to a ball at a metre by what a camera sees, and stands where it may kick") {
  const Approach problem = Approach::ha();
  WalkingTwin robot;
  const BallView start{1, 0, 0};
  const surefoot::Pose2 ball = robot.twin().pose() * start;
  const KickApproach walked =
      walk_to_kick(problem, Winner2016(Winner2016Parameters::tuned()), robot, start, {}, 60, surefoot::Rng(2));
  CHECK(walked.reached);
  CHECK_FALSE(walked.fell);
  CHECK(walked.seconds > 5);
  const surefoot::Pose2 seen = robot.twin().pose().inverse() * ball;
  CHECK(problem.can_kick(seen.x, seen.y, seen.angle));
}

TEST_CASE("an approach that is given no time gives up") {
  WalkingTwin robot;
  const KickApproach walked = walk_to_kick(Approach::ha(), Winner2016(), robot, {1, 0, 0}, {}, 1, surefoot::Rng(2));
  CHECK_FALSE(walked.reached);
  CHECK(walked.seconds < 2);
}

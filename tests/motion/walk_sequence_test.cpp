#include "surefoot/motion/walk_sequence.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "surefoot/motion/linear_correction.hpp"
#include "tests/support/walks.hpp"

using surefoot::MotionError;
using surefoot::WalkSequence;

namespace {

WalkSequence two_cycles() {
  WalkSequence sequence{.name = "kitchen"};
  sequence.commands.resize(3, 2);
  sequence.commands << 1, 1, 0, 0, std::numbers::pi / 2, 0;
  sequence.poses.setConstant(3, 2, std::nan(""));
  sequence.poses.col(1) << 1, 1, std::numbers::pi / 2;
  return sequence;
}

}  // namespace

TEST_CASE("a cycle is walked in the frame before it") {
  const auto end = predict_final_pose(surefoot::FullLinearCorrection(), two_cycles());
  CHECK(end.x == doctest::Approx(1));
  CHECK(end.y == doctest::Approx(1));
  CHECK(end.angle == doctest::Approx(std::numbers::pi / 2));
}

TEST_CASE("the error of final poses is in metres and in radians, and tolerance forgives small angles") {
  std::vector<WalkSequence> sequences{two_cycles(), two_cycles()};
  sequences[1].poses.col(1) << 1, 1.4, std::numbers::pi / 2 - 0.2 + 2 * std::numbers::pi;
  const surefoot::FullLinearCorrection model;
  const auto error = final_pose_error(model, std::span<const WalkSequence>(sequences));
  CHECK(error.position == doctest::Approx(0.4 / std::sqrt(2)));
  CHECK(error.heading == doctest::Approx(0.2 / std::sqrt(2)));
  CHECK(final_pose_error(model, std::span<const WalkSequence>(sequences), 0.15).heading ==
        doctest::Approx(0.05 / std::sqrt(2)));
  sequences[1].poses(2, 1) = std::nan("");
  CHECK(final_pose_error(model, std::span<const WalkSequence>(sequences)).heading == doctest::Approx(0).epsilon(1e-9));
}

TEST_CASE("a sequence that cannot be used is named") {
  const auto message = [](const WalkSequence& sequence) {
    try {
      check(sequence);
      return std::string("fine");
    } catch (const MotionError& error) {
      return std::string(error.what());
    }
  };
  WalkSequence sequence = two_cycles();
  CHECK(message(sequence) == "fine");
  sequence.poses(0, 1) = std::nan("");
  CHECK(message(sequence) ==
        "sequence kitchen: has no final position; measure where the robot stopped, or leave the sequence out");
  sequence = two_cycles();
  sequence.commands(2, 0) = std::nan("");
  CHECK(message(sequence) == "sequence kitchen: has a command that is not a number");
  CHECK(message(WalkSequence{.name = "kitchen"}) == "sequence kitchen: has no cycle");
  CHECK_THROWS_WITH_AS(surefoot::check(std::span<const WalkSequence>()), "there is no sequence to calibrate from",
                       MotionError);
}

TEST_CASE("a tape sees the final pose only") {
  const auto walks = toys::walks(toys::paper_walk(), toys::paper_noise(), 1, 1);
  const WalkSequence taped = final_pose_only(walks[0]);
  CHECK(taped.poses.col(24) == walks[0].poses.col(24));
  for (int i = 0; i < 24; ++i) CHECK_FALSE(taped.position_measured(i));
}

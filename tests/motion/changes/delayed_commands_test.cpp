#include "surefoot/motion/changes/delayed_commands.hpp"

#include <doctest/doctest.h>

#include "tests/support/walks.hpp"

using surefoot::detail::delayed;

TEST_CASE("a robot that does each command two cycles later is as one that does it at once, told later") {
  auto walks = toys::walks(toys::paper_walk(), surefoot::MotionNoise(), 3, 5, 12);
  for (auto& walk : walks) {
    const Eigen::Matrix3Xd done = walk.commands;
    walk.commands.leftCols(10) = done.rightCols(10);
  }
  const auto late = delayed(walks, 2);
  REQUIRE(late[0].cycles() == 9);  // the commands of the first two are not known, nor what came before the third
  CHECK(surefoot::final_pose_error(toys::paper_walk(), late).position < 1e-9);
  CHECK(surefoot::final_pose_error(toys::paper_walk(), walks).position > 0.01);
  CHECK(delayed(toys::final_poses(walks), 2)[0].cycles() == 12);
  CHECK(delayed(walks, 0)[0].cycles() == 12);
}

TEST_CASE("delays are counted from that of the old walk") {
  CHECK(surefoot::detail::possible_delays(0, 2) == std::vector<int>{0, 1, 2});
  CHECK(surefoot::detail::possible_delays(1, 2) == std::vector<int>{0, -1, 1});
}

TEST_CASE("commands that stay the same within each sequence show no delay") {
  auto walks = toys::walks(toys::paper_walk(), surefoot::MotionNoise(), 3, 5, 12);
  for (std::size_t i = 0; i < walks.size(); ++i) {
    for (Eigen::Index k = 0; k < 12; ++k) walks[i].commands.col(k) << 0.01 * static_cast<double>(i), 0, -0.02;
  }
  CHECK_FALSE(surefoot::detail::commands_vary(walks));
  for (auto& walk : walks) walk.commands(0, 5) += 0.03;
  CHECK(surefoot::detail::commands_vary(walks));
}

// How a walk stops: signals as requests, a quick end of the gait, the pose from which it goes limp, a ball that is far.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "examples/sigmaban/robot/walk/far_ball.hpp"
#include "examples/sigmaban/robot/walk/gait.hpp"
#include "examples/sigmaban/robot/walk/sitting_pose.hpp"
#include "examples/sigmaban/robot/walk/stop_signals.hpp"
#include "examples/sigmaban/robot/walk/walk_loop.hpp"

using namespace sigmaban;

namespace {

bool becomes(const StopSignals& signals, StopRequest wanted) {
  for (int i = 0; i < 1000 && signals.request() != wanted; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return signals.request() == wanted;
}

}  // namespace

TEST_CASE("the first signal of any kind asks to stop in order, the second to stop at once") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGUSR1, SIGALRM}) {
    CAPTURE(signal);
    StopSignals signals;
    signals.no_more_deadlines();
    CHECK_FALSE(signals.requested());
    kill(getpid(), signal);
    CHECK(becomes(signals, StopRequest::in_order));
    kill(getpid(), SIGINT);
    CHECK(becomes(signals, StopRequest::at_once));
  }
}

TEST_CASE("a gait that stops quickly stands within a second, from any stage") {
  for (const double after_s : {0.5, 3.0, 6.0}) {
    Gait gait({.slowing = {0.02, 0.01, 0.15}});
    for (double t = 0; t < after_s; t += 0.01) {
      if (gait.stage() != GaitStage::rise) gait.begin_cycle({0.04, 0, 0});
      static_cast<void>(gait.advance(0.01));
    }
    gait.stop_quickly();
    double time = 0, enabled = 1;
    for (; gait.stage() != GaitStage::done && time < 5; time += 0.01) {
      const double next = gait.advance(0.01).enabled;
      CHECK(next <= enabled);
      enabled = next;
    }
    CHECK(time < 1);
    CHECK(enabled == 0);
  }
}

TEST_CASE("a sitting robot has its knees bent and its feet flat under the hips") {
  const auto pose = sitting_pose({});
  REQUIRE(pose);
  CHECK(pose->left.knee > 1);
  CHECK(pose->left.hip_pitch + pose->left.knee + pose->left.ankle_pitch == doctest::Approx(0).epsilon(1e-9));
  CHECK(pose->left.knee == doctest::Approx(pose->right.knee));
  for (const double angle : pose->array()) CHECK(std::abs(angle) < 2.6);
  CHECK_FALSE(sitting_pose({}, -0.5));
}

TEST_CASE("a ball beyond the area is brought to its edge, and lost after many sightings without coming closer") {
  FarBall far({.most_cycles = 4});
  const BallView near = far.within({0.5, 0.2, 1}, 1);
  CHECK(near.x == 0.5);
  const BallView edge = far.within({1.5, 2, 1}, 1);
  CHECK(std::hypot(edge.x, edge.y) == doctest::Approx(0.999));
  CHECK(edge.y / edge.x == doctest::Approx(2 / 1.5));
  for (int i = 0; i < 3; ++i) static_cast<void>(far.within({1.5, 2, 1}, 1));
  CHECK_FALSE(far.lost());
  static_cast<void>(far.within({1.5, 1.9, 1}, 1));  // closer
  for (int i = 0; i < 3; ++i) static_cast<void>(far.within({1.5, 2, 1}, 1));
  CHECK_FALSE(far.lost());
  static_cast<void>(far.within({1.5, 2, 1}, 1));
  CHECK(far.lost());
  static_cast<void>(far.within({0.9, 0, 1}, 1));
  CHECK_FALSE(far.lost());
}

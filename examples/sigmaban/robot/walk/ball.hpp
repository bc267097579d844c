// Where the ball and the kick target are: simulated, or from whoever can see.
#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "line_reader.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"

namespace sigmaban {

/// Seen from the robot: position of the ball [m] and direction of the kick [rad].
using BallView = surefoot::Pose2;

/// `see` is asked where a walk cycle begins, with the speeds of the cycle that ended and of the one before it
/// [m/step, m/step, rad/step]; nothing where there is no new sighting. It must not wait.
///
///   struct Penalty {
///     std::optional<BallView> see(const surefoot::Vec<3>&, const surefoot::Vec<3>&) { return BallView{0.5, 0, 0}; }
///   };
template <class T>
concept BallSource = requires(T& source, const surefoot::Vec<3>& speed) {
  { source.see(speed, speed) } -> std::same_as<std::optional<BallView>>;
};

/// Lies still, while the robot walks as its model says, with the model's noise.
template <class Problem>
class SimulatedBall {
 public:
  SimulatedBall(const Problem& problem, const BallView& start, const surefoot::Rng& rng)
      : problem_(&problem), view_(start), rng_(rng) {}

  std::optional<BallView> see(const surefoot::Vec<3>& speed, const surefoot::Vec<3>& before) {
    if (!first_) {
      const surefoot::Pose2 move = problem_->walk_cycle(speed, before, rng_);  // the robot turns, then walks
      const BallView turned = BallView{0, 0, -move.angle} * view_;
      view_ = {turned.x - move.x, turned.y - move.y, surefoot::wrap_angle(turned.angle)};
    }
    first_ = false;
    return view_;
  }

 private:
  const Problem* problem_;
  BallView view_;
  surefoot::Rng rng_;
  bool first_ = true;
};

/// Read from a file, a named pipe or "-" (standard input), one line per sight: x y kick [m, m, rad]. The newest counts,
/// once, unless it is older than `valid_s`. A line that is none is ignored and counted.
class BallReader {
 public:
  /// Throws UsageError if the file cannot be opened.
  explicit BallReader(const std::string& path, double valid_s = 0.6)
      : valid_s_(valid_s), reader_(path, [this](const std::string& line) { take(line); }) {}

  std::optional<BallView> see(const surefoot::Vec<3>& /*speed*/, const surefoot::Vec<3>& /*before*/) {
    const std::lock_guard lock(mutex_);
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - time_;
    const std::optional<BallView> seen = std::exchange(newest_, std::nullopt);
    return age.count() > valid_s_ ? std::nullopt : seen;
  }

  std::uint64_t ignored() const { return ignored_; }

 private:
  void take(const std::string& line) {
    BallView view;
    if (std::sscanf(line.c_str(), "%lf %lf %lf", &view.x, &view.y, &view.angle) != 3 || !std::isfinite(view.x) ||
        !std::isfinite(view.y) || !std::isfinite(view.angle)) {
      ++ignored_;
      return;
    }
    const std::lock_guard lock(mutex_);
    newest_ = view;
    time_ = std::chrono::steady_clock::now();
  }

  double valid_s_;
  std::mutex mutex_;
  std::optional<BallView> newest_;
  std::chrono::steady_clock::time_point time_{};
  std::atomic<std::uint64_t> ignored_{0};
  LineReader reader_;  // the last one: its thread uses the others
};

}  // namespace sigmaban

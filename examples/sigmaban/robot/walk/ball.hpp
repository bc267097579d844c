// Where the ball and the kick target are: simulated, or from whoever can see.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "../../../../apps/common/usage_error.hpp"
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
  explicit BallReader(const std::string& path, double valid_s = 0.6) : valid_s_(valid_s) {
    file_ = path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file_ < 0) throw example::UsageError(path + ": cannot be read (" + std::strerror(errno) + ")");
    thread_ = std::thread([this] { run(); });
  }

  ~BallReader() {
    ending_ = true;
    thread_.join();
    close(file_);
  }
  BallReader(const BallReader&) = delete;
  BallReader& operator=(const BallReader&) = delete;

  std::optional<BallView> see(const surefoot::Vec<3>& /*speed*/, const surefoot::Vec<3>& /*before*/) {
    const std::lock_guard lock(mutex_);
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - time_;
    const std::optional<BallView> seen = std::exchange(newest_, std::nullopt);
    return age.count() > valid_s_ ? std::nullopt : seen;
  }

  std::uint64_t ignored() const { return ignored_; }

 private:
  void run() {
    std::string line;
    std::array<char, 512> bytes{};
    while (!ending_) {
      pollfd waiting{file_, POLLIN, 0};
      if (poll(&waiting, 1, 50) <= 0) continue;
      const auto count = ::read(file_, bytes.data(), bytes.size());
      if (count <= 0) {  // nobody writes now: somebody may later
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        continue;
      }
      for (const char c : std::string_view(bytes.data(), static_cast<std::size_t>(count))) {
        if (c != '\n') {
          if (line.size() < bytes.size()) line += c;
          continue;
        }
        take(line);
        line.clear();
      }
    }
  }

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

  int file_ = -1;
  double valid_s_;
  std::mutex mutex_;
  std::optional<BallView> newest_;
  std::chrono::steady_clock::time_point time_{};
  std::atomic<std::uint64_t> ignored_{0};
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace sigmaban

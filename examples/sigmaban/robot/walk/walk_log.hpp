// What happened in every control cycle, as a recording: written by a thread of its own, so that no cycle waits for a
// disk.
#pragma once

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../../../../apps/common/files.hpp"
#include "../walk_engine/joint_targets.hpp"

namespace sigmaban {

/// As many as there can be in a row of the log.
inline constexpr std::size_t most_logged_joints = 20;

/// One control cycle. What is not known is NaN, an empty cell in the file.
struct LogRow {
  double time = 0;                                     // since the start [s]
  std::array<double, 3> orders{};                      // [m/step, m/step, rad/step]
  double enabled = 0;                                  // 0 stands, 1 walks
  double phase = 0;                                    // of the walk
  std::array<double, 3> ball{};                        // x, y, kick direction, as believed [m, m, rad]
  std::array<double, most_logged_joints> goals{};      // as sent [rad], as the next
  std::array<double, most_logged_joints> positions{};  // measured
  std::array<double, most_logged_joints> currents{};   // [A]
  std::array<double, most_logged_joints> voltages{};   // [V]
  double lateness = 0;                                 // of the cycle's start [s]
};

class WalkLog {
 public:
  /// Nothing is written if `path` is empty. Throws UsageError if it cannot be. `joints` has at most most_logged_joints.
  explicit WalkLog(const std::filesystem::path& path,
                   std::vector<std::string> joints = {joint_names.begin(), joint_names.end()})
      : joints_(std::move(joints)), rows_(path.empty() ? 0 : capacity) {
    if (path.empty()) return;
    example::prepare_output(path);
    file_ = std::fopen(path.c_str(), "w");
    if (file_ == nullptr) {
      throw example::UsageError(path.string() + ": cannot be written (" + std::strerror(errno) + ")");
    }
    write_header();
    thread_ = std::thread([this] { run(); });
  }

  ~WalkLog() {
    if (file_ == nullptr) return;
    ending_ = true;
    thread_.join();
    std::fclose(file_);
  }
  WalkLog(const WalkLog&) = delete;
  WalkLog& operator=(const WalkLog&) = delete;

  /// Never waits. A row is lost, and counted, if the disk is more than 40 s behind.
  void add(const LogRow& row) {
    if (file_ == nullptr) return;
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == capacity) {
      ++lost_;
      return;
    }
    rows_[end % capacity] = row;
    end_.store(end + 1, std::memory_order_release);
  }

  std::uint64_t lost() const { return lost_; }
  bool failed() const { return failed_; }  // to write

 private:
  static constexpr std::size_t capacity = 4096;

  void write_header() {
    std::string line = "t_s,order_dx_m,order_dy_m,order_dtheta_rad,enabled_1,phase_1,ball_x_m,ball_y_m,kick_rad";
    for (const char* what : {"goal", "position", "current", "voltage"}) {
      for (const std::string& joint : joints_) {
        line += "," + std::string(what) + "_" + joint + (*what == 'v' ? "_V" : *what == 'c' ? "_A" : "_rad");
      }
    }
    std::fprintf(file_, "%s,lateness_s\n", line.c_str());
  }

  void run() {
    while (true) {
      const bool last = ending_;
      std::size_t begin = begin_.load(std::memory_order_relaxed);
      for (const std::size_t end = end_.load(std::memory_order_acquire); begin < end; ++begin) {
        write(rows_[begin % capacity]);
        begin_.store(begin + 1, std::memory_order_release);
      }
      if (std::fflush(file_) != 0) failed_ = true;
      if (last) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }

  void write(const LogRow& row) {
    const auto put = [&](double value) {
      if (std::isfinite(value)) {
        std::fprintf(file_, ",%.6g", value);
      } else {
        std::fputc(',', file_);
      }
    };
    std::fprintf(file_, "%.6f", row.time);
    for (const double value : row.orders) put(value);
    put(row.enabled);
    put(row.phase);
    for (const double value : row.ball) put(value);
    for (const auto* joints : {&row.goals, &row.positions, &row.currents, &row.voltages}) {
      for (std::size_t i = 0; i < joints_.size(); ++i) put((*joints)[i]);
    }
    put(row.lateness);
    std::fputc('\n', file_);
  }

  std::vector<std::string> joints_;
  std::vector<LogRow> rows_;  // a ring: rows begin to end wait to be written
  std::atomic<std::size_t> begin_{0}, end_{0};
  std::uint64_t lost_ = 0;
  std::FILE* file_ = nullptr;
  std::atomic<bool> ending_{false}, failed_{false};
  std::thread thread_;
};

}  // namespace sigmaban

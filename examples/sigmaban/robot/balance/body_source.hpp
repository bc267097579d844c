// Where readings of the body come from: a pipe that another program writes, or devices on a servo bus.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <locale>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "../walk/line_reader.hpp"
#include "body_reading.hpp"

namespace sigmaban {

/// `feel` is asked once in every control cycle; nothing where there is no reading that is new enough. It must not wait
/// for longer than a part of the cycle.
///
///   struct Numb { std::optional<BodyReading> feel() { return std::nullopt; } };
template <class T>
concept BodySource = requires(T& source) {
  { source.feel() } -> std::same_as<std::optional<BodyReading>>;
};

/// Somebody else puts the reading of each cycle into it; it counts once.
struct HandedReading {
  std::optional<BodyReading> newest{};
  std::optional<BodyReading> feel() { return std::exchange(newest, std::nullopt); }
};

/// Read from a file, a named pipe or "-": a line of ten numbers for each reading, gyroscope [rad/s] and accelerometer
/// [m/s^2] (x y z each), loads under the left and the right foot [N], their centres ahead of the middle of each foot
/// [m]. The newest counts for as long as `valid_s`. Lines that are none are ignored and counted.
class BodyReader {
 public:
  /// Throws UsageError if the file cannot be opened.
  explicit BodyReader(const std::string& path, double valid_s = 0.05)
      : valid_s_(valid_s), reader_(path, [this](const std::string& line) { take(line); }) {}

  std::optional<BodyReading> feel() {
    const std::lock_guard lock(mutex_);
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - time_;
    return newest_ && age.count() <= valid_s_ ? newest_ : std::nullopt;
  }

  std::uint64_t ignored() const { return ignored_; }

 private:
  void take(const std::string& line) {
    std::array<double, 10> v{};
    std::istringstream numbers(line);
    numbers.imbue(std::locale::classic());
    for (double& value : v) numbers >> value;
    if (!numbers || !std::ranges::all_of(v, [](double value) { return std::isfinite(value); })) {
      ++ignored_;
      return;
    }
    const std::lock_guard lock(mutex_);
    newest_ = BodyReading{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7]}, {v[8], v[9]}};
    time_ = std::chrono::steady_clock::now();
  }

  double valid_s_;
  std::mutex mutex_;
  std::optional<BodyReading> newest_;
  std::chrono::steady_clock::time_point time_{};
  std::atomic<std::uint64_t> ignored_{0};
  LineReader reader_;  // the last one: its thread uses the others
};

}  // namespace sigmaban

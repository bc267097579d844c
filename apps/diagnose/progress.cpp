#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace diagnose_program {

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() { close(); }

void Progress::close() {
  if (open_) std::cerr << "\r\033[K" << std::flush;
  open_ = false;
}

void Progress::show(std::string_view stage, double share, std::string_view best) {
  if (quiet_) return;
  const auto now = Clock::now();
  if (share < share_) began_ = now;
  share_ = share;
  const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10'000);
  if (stage == stage_ && now - shown_ < pause) return;
  stage_ = stage;
  shown_ = now;
  const double passed = std::chrono::duration<double>(now - began_).count();
  std::string line = "[" + std::to_string(static_cast<int>(100 * std::clamp(share, 0.0, 1.0))) + " %] " + stage_;
  if (!best.empty()) line += ", best so far: " + std::string(best);
  if (share > 0.02 && share < 1 && passed > 1) line += ", about " + duration_text(passed / share - passed) + " left";
  if (terminal_) {
    std::cerr << "\r\033[K" << line.substr(0, 118) << std::flush;
  } else {
    std::cerr << line << '\n';
  }
  open_ = terminal_;
}

std::string duration_text(double seconds) {
  const auto total = static_cast<long>(std::lround(std::max(0.0, seconds)));
  if (total < 60) return std::to_string(total) + " s";
  if (total < 3600) return std::to_string(total / 60) + " min " + std::to_string(total % 60) + " s";
  return std::to_string(total / 3600) + " h " + std::to_string(total % 3600 / 60) + " min";
}

}  // namespace diagnose_program

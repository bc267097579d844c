// Progress while a diagnosis works: stage, share done, best so far, time left.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace diagnose_program {

/// On a terminal one line that is written over; elsewhere plain lines, one for each stage and one every ten seconds.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Removes the line from the terminal.
  void close();
  void show(std::string_view stage, double share, std::string_view best);

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, terminal_, open_ = false;  // open: a line without its end stands on the terminal
  Clock::time_point began_ = Clock::now(), shown_{};  // began: or began anew, from a smaller share on
  double share_ = 0;
  std::string stage_;
};

/// "42 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

}  // namespace diagnose_program

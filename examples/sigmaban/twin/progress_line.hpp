// How far long work has come, on the terminal's error stream.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

namespace sigmaban {

/// Prints "[40 %] 80 of 200 sequences, about 12 s left", at most once per second.
class ProgressLine {
 public:
  ProgressLine(std::string what, std::size_t total) : what_(std::move(what)), total_(total) {}

  void operator()(std::size_t done) {
    const std::chrono::duration<double> passed = Clock::now() - began_;
    if (passed.count() < printed_ + 1) return;
    printed_ = passed.count();
    const double left = printed_ * static_cast<double>(total_ - done) / static_cast<double>(done);
    std::fprintf(stderr, "[%zu %%] %zu of %zu %s, about %.0f s left\n", 100 * done / total_, done, total_,
                 what_.c_str(), left);
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  std::size_t total_;
  Clock::time_point began_ = Clock::now();
  double printed_ = 0;  // [s]
};

}  // namespace sigmaban

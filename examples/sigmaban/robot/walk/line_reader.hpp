// Lines of text that another program writes, taken as they come.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "../../../../apps/common/usage_error.hpp"

namespace sigmaban {

/// Reads a file, a named pipe or "-" (standard input) in a thread of its own, for as long as it lives: a writer may go,
/// and another may come.
class LineReader {
 public:
  /// take(line) is called in that thread. Throws UsageError if the file cannot be opened.
  LineReader(const std::string& path, std::function<void(const std::string&)> take) : take_(std::move(take)) {
    file_ = path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file_ < 0) throw example::UsageError(path + ": cannot be read (" + std::strerror(errno) + ")");
    thread_ = std::thread([this] { run(); });
  }

  ~LineReader() {
    ending_ = true;
    thread_.join();
    close(file_);
  }
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

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
        take_(line);
        line.clear();
      }
    }
  }

  std::function<void(const std::string&)> take_;
  int file_ = -1;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace sigmaban

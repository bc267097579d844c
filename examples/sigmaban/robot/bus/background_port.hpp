// A port that a thread of its own reads, so that a control cycle waits for nothing but the time it asked for: waits for
// a terminal may end late (see SerialPort::read), those here do not.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "transport.hpp"

namespace dynamixel {

/// A transport over another one, whose clock is the monotonic one and whose read() and write() may run at the same
/// time. Errors of reading are thrown by the next read(). Reads allocate nothing.
template <Transport Port>
class BackgroundPort {
 public:
  explicit BackgroundPort(Port port) : shared_(std::make_unique<Shared>(std::move(port))) {
    shared_->thread = std::thread([shared = shared_.get()] { shared->run(); });
  }

  Time now() const { return std::chrono::steady_clock::now().time_since_epoch(); }
  std::uint32_t bits_per_s() const { return shared_->port.bits_per_s(); }
  void write(Bytes bytes, Time deadline) { shared_->port.write(bytes, deadline); }
  const Port& port() const { return shared_->port; }

  std::size_t read(Buffer out, Time deadline) {
    Shared& shared = *shared_;
    std::unique_lock lock(shared.mutex);
    const std::chrono::steady_clock::time_point until(deadline);
    shared.news.wait_until(lock, until, [&] { return shared.size > 0 || shared.error; });
    if (shared.size == 0 && shared.error) std::rethrow_exception(shared.error);
    const std::size_t count = std::min(out.size(), shared.size);
    std::copy_n(shared.bytes.begin(), count, out.begin());
    std::copy(shared.bytes.begin() + static_cast<std::ptrdiff_t>(count),
              shared.bytes.begin() + static_cast<std::ptrdiff_t>(shared.size), shared.bytes.begin());
    shared.size -= count;
    return count;
  }

 private:
  struct Shared {
    explicit Shared(Port p) : port(std::move(p)) {}
    ~Shared() {
      ending = true;
      thread.join();
    }

    void run() {
      std::array<std::uint8_t, 1024> read{};
      try {
        while (!ending) {
          const std::size_t count = port.read(read, port.now() + std::chrono::milliseconds(50));
          const std::lock_guard lock(mutex);
          const std::size_t kept = std::min(count, bytes.size() - size);  // nobody takes them: the newest are lost
          std::copy_n(read.begin(), kept, bytes.begin() + static_cast<std::ptrdiff_t>(size));
          size += kept;
          if (kept > 0) news.notify_one();
        }
      } catch (...) {
        const std::lock_guard lock(mutex);
        error = std::current_exception();
        news.notify_one();
      }
    }

    Port port;
    std::mutex mutex;
    std::condition_variable news;
    std::array<std::uint8_t, 4096> bytes{};
    std::size_t size = 0;
    std::exception_ptr error;
    std::atomic<bool> ending{false};
    std::thread thread;
  };

  std::unique_ptr<Shared> shared_;
};

}  // namespace dynamixel

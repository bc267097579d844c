// A line without a port: the answerer's bytes at once, on a clock that jumps to whatever is waited for. For tests and
// simulations, which are then quick and give the same bits each time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "answerer.hpp"

namespace dynamixel {

template <class Protocol>
class MemoryTransport {
 public:
  /// `answerer` must outlive this. `chunk`: bytes that a read gives at most. `echo`: hands back what is written.
  explicit MemoryTransport(Answerer<Protocol>& answerer, std::size_t chunk = std::numeric_limits<std::size_t>::max(),
                           bool echo = false)
      : answerer_(&answerer), chunk_(chunk), echo_(echo) {}

  Time now() const { return now_; }
  std::uint32_t bits_per_s() const { return answerer_->bits_per_s(); }
  /// Lets time pass.
  void wait(Time duration) { now_ += duration; }
  void wait_until(Time time) { now_ = std::max(now_, time); }
  /// As an adapter that is pulled out.
  void hang_up() { gone_ = true; }
  bool gone() const { return gone_; }

  void write(Bytes bytes, Time) {
    if (gone_) throw BusError("memory: the port is gone");
    if (echo_) inject(bytes);
    answerer_->receive(bytes, now_);
  }

  /// Puts bytes before whatever comes; what does not fit is dropped.
  void inject(Bytes bytes) {
    const std::size_t count = std::min(bytes.size(), waiting_.size() - end_);
    std::copy_n(bytes.begin(), count, waiting_.begin() + static_cast<std::ptrdiff_t>(end_));
    end_ += count;
  }

  std::size_t read(Buffer out, Time deadline) {
    if (gone_) throw BusError("memory: the port is gone");
    if (begin_ == end_) {
      begin_ = end_ = 0;
      const auto due = answerer_->next_due();
      if (!due || *due > deadline) {
        now_ = std::max(now_, deadline);
        return 0;
      }
      now_ = std::max(now_, *due);
      end_ = answerer_->take(now_, waiting_);
    }
    const std::size_t count = std::min({out.size(), chunk_, end_ - begin_});
    std::copy_n(waiting_.begin() + static_cast<std::ptrdiff_t>(begin_), count, out.begin());
    begin_ += count;
    return count;
  }

 private:
  Answerer<Protocol>* answerer_;
  std::size_t chunk_;
  bool echo_;
  bool gone_ = false;
  Time now_{};
  std::array<std::uint8_t, 1024> waiting_{};
  std::size_t begin_ = 0, end_ = 0;
};

}  // namespace dynamixel

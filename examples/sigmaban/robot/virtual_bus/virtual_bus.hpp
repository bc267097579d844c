// Servos behind a pseudo-terminal, at the pace of a real line: whoever opens path() finds them there.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "answerer.hpp"
#include "pseudo_terminal.hpp"

namespace dynamixel {

/// Answers from a thread of its own for as long as it lives. It sleeps until an answer is due, so how exactly the pace
/// is kept depends on the operating system.
template <class Protocol>
class VirtualBus {
 public:
  explicit VirtualBus(Answerer<Protocol> answerer) : answerer_(std::move(answerer)), thread_([this] { run(); }) {}

  ~VirtualBus() {
    ending_ = true;
    terminal_.wake();
    thread_.join();
  }

  VirtualBus(const VirtualBus&) = delete;
  VirtualBus& operator=(const VirtualBus&) = delete;

  const std::string& path() const { return terminal_.path(); }

  /// As an adapter that is pulled out. The servos live on, without instructions.
  void hang_up() {
    hanging_up_ = true;
    terminal_.wake();
  }

  /// action(answerer), while nothing else happens to it; returns what it does.
  template <class Action>
  auto with(Action action) {
    const std::lock_guard lock(mutex_);
    return action(answerer_);
  }

 private:
  void run() {
    std::array<std::uint8_t, 4096> bytes;
    while (!ending_) {
      if (hanging_up_.exchange(false)) terminal_.hang_up();
      const Time idle = PseudoTerminal::now() + std::chrono::milliseconds(20);
      const Time deadline = with([&](auto& answerer) { return answerer.next_due().value_or(idle); });
      const std::size_t count = terminal_.read(bytes, deadline);
      with([&](auto& answerer) {
        const Time now = PseudoTerminal::now();
        if (count > 0 && answerer.own_speeds()) answerer.set_speed(terminal_.bits_per_s());
        count > 0 ? answerer.receive(Bytes(bytes).first(count), now) : answerer.advance(now);
      });
      const auto take = [&](auto& answerer) { return answerer.take(PseudoTerminal::now(), bytes); };
      while (const std::size_t size = with(take)) terminal_.write(Bytes(bytes).first(size));
    }
  }

  PseudoTerminal terminal_;
  std::mutex mutex_;
  Answerer<Protocol> answerer_;
  std::atomic<bool> ending_{false}, hanging_up_{false};
  std::thread thread_;
};

}  // namespace dynamixel

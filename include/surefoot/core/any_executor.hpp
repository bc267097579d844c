// An executor of any type behind one type, chosen when a program runs; what uses it is compiled once.
#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <memory>
#include <stop_token>
#include <utility>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"

namespace surefoot {

/// Runs jobs as the executor does that it holds, in one process or in several, with the same results. A job costs a
/// call through a pointer more.
class AnyExecutor {
 public:
  template <Executor E>
  explicit AnyExecutor(std::unique_ptr<E> executor) : held_(std::make_unique<Held<E>>(std::move(executor))) {}

  std::size_t width() const { return held_->width(); }
  std::size_t processes() const { return held_->processes(); }

  template <std::invocable<std::size_t> Job>
  bool run(std::size_t count, Job&& job, std::stop_token stop = {}) const {
    return held_->run(count, std::ref(job), std::move(stop));
  }

  template <std::invocable<std::size_t> Job, std::invocable<std::size_t, ByteWriter&> Pack,
            std::invocable<std::size_t, ByteReader&> Unpack>
  bool run_apart(std::size_t count, Job&& job, std::stop_token stop, Pack&& pack, Unpack&& unpack) const {
    return held_->run_apart(count, std::ref(job), std::move(stop), std::ref(pack), std::ref(unpack));
  }

 private:
  using AnyJob = std::function<void(std::size_t)>;
  using AnyPack = std::function<void(std::size_t, ByteWriter&)>;
  using AnyUnpack = std::function<void(std::size_t, ByteReader&)>;

  struct Interface {
    virtual ~Interface() = default;
    virtual std::size_t width() const = 0;
    virtual std::size_t processes() const = 0;
    virtual bool run(std::size_t count, const AnyJob& job, std::stop_token stop) const = 0;
    virtual bool run_apart(std::size_t count, const AnyJob& job, std::stop_token stop, const AnyPack& pack,
                           const AnyUnpack& unpack) const = 0;
  };

  template <Executor E>
  struct Held final : Interface {
    explicit Held(std::unique_ptr<E> held) : executor(std::move(held)) {}

    std::size_t width() const override { return executor->width(); }
    std::size_t processes() const override {
      if constexpr (Distributed<E>) return executor->processes();
      return 1;
    }
    bool run(std::size_t count, const AnyJob& job, std::stop_token stop) const override {
      return executor->run(count, job, std::move(stop));
    }
    bool run_apart(std::size_t count, const AnyJob& job, std::stop_token stop, [[maybe_unused]] const AnyPack& pack,
                   [[maybe_unused]] const AnyUnpack& unpack) const override {
      if constexpr (Distributed<E>) {
        return executor->run_apart(count, job, std::move(stop), pack, unpack);
      } else {
        return executor->run(count, job, std::move(stop));
      }
    }

    std::unique_ptr<E> executor;
  };

  std::unique_ptr<const Interface> held_;
};

}  // namespace surefoot

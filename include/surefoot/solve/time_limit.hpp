// A stop request when the time is up.
#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

#include "surefoot/core/compiled.hpp"

namespace surefoot::detail {

/// Passes a stop request on, and makes one of its own when the time is up.
class TimeLimit {
 public:
  TimeLimit(std::stop_token outer, double seconds);

  std::stop_token token() const { return source_.get_token(); }
  bool struck() const { return struck_; }

 private:
  struct Request {
    std::stop_source* source;
    void operator()() const { source->request_stop(); }
  };
  std::stop_source source_;
  std::atomic<bool> struck_ = false;
  std::stop_callback<Request> forward_;
  std::jthread timer_;
};

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/solve/time_limit.ipp"
#endif

// One process that plays the part of many: does all jobs itself, and notes how long each takes and what would travel.
#pragma once

#include <time.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"

namespace scaling {

/// CPU time of this thread [s]: other programs on the machine hardly change it.
inline double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A run whose results are shared.
struct Round {
  std::vector<double> jobs;  // [s] each
  double pack = 0;           // [s] all results into bytes
  double unpack = 0;         // [s] and back
  std::size_t bytes = 0;
};

class TracedExecutor {
 public:
  std::size_t processes() const { return 1; }
  std::size_t width() const { return 1; }

  template <std::invocable<std::size_t> Job>
  bool run(std::size_t count, Job&& job, std::stop_token stop = {}) const {
    return surefoot::Serial{}.run(count, job, stop);
  }

  template <std::invocable<std::size_t> Job, class Pack, class Unpack>
  bool run_apart(std::size_t count, Job&& job, std::stop_token /*stop*/, const Pack& pack, const Unpack& unpack) const {
    Round round;
    double before = cpu_seconds();
    const auto lap = [&before] {
      const double now = cpu_seconds();
      return now - std::exchange(before, now);
    };
    for (std::size_t i = 0; i < count; ++i) {
      job(i);
      round.jobs.push_back(lap());
    }
    surefoot::ByteWriter out;
    for (std::size_t i = 0; i < count; ++i) pack(i, out);
    round.pack = lap();
    surefoot::ByteReader in(out.bytes(), "trace");
    for (std::size_t i = 0; i < count; ++i) unpack(i, in);
    round.unpack = lap();
    round.bytes = out.size();
    rounds_.push_back(round);
    return true;
  }

  const std::vector<Round>& rounds() const { return rounds_; }

 private:
  mutable std::vector<Round> rounds_;
};
static_assert(surefoot::Distributed<TracedExecutor>);

/// What connects the processes.
struct Network {
  const char* name;
  double latency;    // of a message [s]
  double bandwidth;  // [bytes/s]
};

/// What the run would take on many processes of one thread each [s].
struct Prediction {
  double jobs = 0;     // of the process that has most to do, round by round
  double packing = 0;  // own results into bytes, the others' out of them
  double network = 0;  // two all-gathers per round: log2(P) messages, all bytes to everyone
};

inline Prediction predict(const std::vector<Round>& rounds, std::size_t processes, const Network& network) {
  Prediction sum;
  const auto p = static_cast<double>(processes);
  for (const Round& round : rounds) {
    std::vector<double> busy(processes, 0);
    for (std::size_t i = 0; i < round.jobs.size(); ++i) busy[i % processes] += round.jobs[i];
    sum.jobs += *std::max_element(busy.begin(), busy.end());
    if (processes == 1) continue;
    sum.packing += round.pack / p + round.unpack * (1 - 1 / p);
    sum.network += 2 * std::ceil(std::log2(p)) * network.latency +
                   (32 * p + static_cast<double>(round.bytes)) * (1 - 1 / p) / network.bandwidth;
  }
  return sum;
}

}  // namespace scaling

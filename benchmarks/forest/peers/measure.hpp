// Durations: CPU time of this process, and of single calls whose data is no longer in the L1 and L2 caches.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "model.hpp"

namespace peers {

/// CPU time of this process so far [s].
double cpu_seconds();

double median(std::vector<double> values);

/// Drives everything else out of the L1 and L2 caches by walking a buffer four times as large as L2 (what sysconf says,
/// or 2 MiB). The last-level cache, the branch predictor and most of the code's L1 lines stay as they are.
class Evictor {
 public:
  Evictor();
  void operator()();
  std::size_t bytes() const { return buffer_.size(); }

 private:
  std::vector<unsigned char> buffer_;
};

/// [ns per prediction]
struct Latency {
  double warm = 0;   // one call after the other, mean
  double cold = 0;   // caches evicted before each call, median, less what reading the clock takes
  double batch = 0;  // all points by one call
};

/// One round; `points` has those that the warm calls go through, `rounds` varies which points the cold ones take.
Latency measure(Model& model, const std::vector<float>& points, Evictor& evict, std::size_t cold_calls,
                std::size_t round);

/// Component by component.
Latency median(const std::vector<Latency>& rounds);

}  // namespace peers

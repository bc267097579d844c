// Pushes by chance: one in every window of time, horizontal, in any direction.
#pragma once

#include <cmath>
#include <numbers>
#include <utility>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"

namespace sigmaban {

struct PushOptions {
  double impulse = 0;     // of each, on the trunk's centre of mass [N s]
  double duration = 0.1;  // of each [s]
  double every = 3;       // one within each such time [s]
};

class Pusher {
 public:
  Pusher(const PushOptions& options, surefoot::Rng rng) : options_(options), rng_(std::move(rng)) {}

  /// In the ground's frame, for the period that begins at `time`, which never goes back [N].
  surefoot::Vec<3> force(double time) {
    if (options_.impulse <= 0) return surefoot::Vec<3>::Zero();
    while (time >= window_end_) {
      at_ = window_end_ + (options_.every - options_.duration) * rng_.uniform();
      direction_ = 2 * std::numbers::pi * rng_.uniform();
      window_end_ += options_.every;
    }
    if (time < at_ || time >= at_ + options_.duration) return surefoot::Vec<3>::Zero();
    return options_.impulse / options_.duration * surefoot::Vec<3>(std::cos(direction_), std::sin(direction_), 0);
  }

 private:
  PushOptions options_;
  surefoot::Rng rng_;
  double window_end_ = 3;  // by then it has stood, and walked on the spot [s]
  double at_ = 0, direction_ = 0;
};

}  // namespace sigmaban

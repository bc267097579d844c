// From standing to walking and back: what the walk engine is told, period by period.
#pragma once

#include <algorithm>
#include <cstdint>

#include "../walk_engine/walk_engine.hpp"
#include "surefoot/core/vec.hpp"

namespace sigmaban {

enum class GaitStage : std::uint8_t { rise, step_in_place, walk, slow_down, settle, done };

struct GaitOptions {
  double rise_s = 2.5;       // until the robot stands; a little longer than the servos' soft start [s]
  double fade_s = 0.6;       // from standing to full steps, and back [s]
  double settle_s = 0.5;     // standing still at the end [s]
  int cycles_on_spot = 2;    // before the first order, and after the last
  surefoot::Vec<3> slowing;  // by which speeds fall per walk cycle [m/step, m/step, rad/step]
};

/// Stands up, steps in place, walks with whatever is wanted, and on request slows down, steps in place and stands.
class Gait {
 public:
  explicit Gait(const GaitOptions& options) : options_(options) {}

  GaitStage stage() const { return stage_; }
  /// [m/step, m/step, rad/step]
  const surefoot::Vec<3>& speed() const { return speed_; }

  /// Whether the next cycle takes a wanted speed.
  bool walking() const { return stage_ == GaitStage::walk; }

  /// To be called where a walk cycle begins: `wanted` counts while walking.
  void begin_cycle(const surefoot::Vec<3>& wanted) {
    if (stage_ == GaitStage::walk) {
      speed_ = wanted;
    } else if (stage_ == GaitStage::step_in_place) {
      if (++cycles_ > options_.cycles_on_spot) stage_ = GaitStage::walk;
    } else if (stage_ == GaitStage::slow_down) {
      cycles_ = speed_.isZero() ? cycles_ + 1 : 0;
      for (int k = 0; k < 3; ++k) {
        speed_[k] -= std::clamp(speed_[k], -options_.slowing[k], options_.slowing[k]);
      }
      if (cycles_ > options_.cycles_on_spot) stage_ = GaitStage::settle;
    }
  }

  /// No way back from it.
  void stop() {
    if (stage_ == GaitStage::rise) stage_ = GaitStage::settle;
    if (stage_ != GaitStage::step_in_place && stage_ != GaitStage::walk) return;
    stage_ = GaitStage::slow_down;
    cycles_ = 0;
  }

  /// Lets the step under way fade out, and stands. No way back from it.
  void stop_quickly() {
    if (stage_ != GaitStage::done) stage_ = GaitStage::settle;
    still_ = std::max(still_, options_.settle_s - short_settle_s);
  }

  /// The orders for the next `duration` [s].
  WalkOrders advance(double duration) {
    const bool steps =
        stage_ == GaitStage::step_in_place || stage_ == GaitStage::walk || stage_ == GaitStage::slow_down;
    const double change = options_.fade_s > 0 ? duration / options_.fade_s : 1;
    enabled_ = std::clamp(enabled_ + (steps ? change : -change), 0.0, 1.0);
    time_ += duration;
    if (stage_ == GaitStage::rise && time_ >= options_.rise_s) {
      stage_ = GaitStage::step_in_place;
    } else if (stage_ == GaitStage::settle) {
      still_ += enabled_ > 0 ? 0 : duration;
      if (still_ >= options_.settle_s) stage_ = GaitStage::done;
    }
    return {speed_[0], speed_[1], speed_[2], enabled_};
  }

 private:
  GaitOptions options_;
  GaitStage stage_ = GaitStage::rise;
  surefoot::Vec<3> speed_ = surefoot::Vec<3>::Zero();
  double time_ = 0, still_ = 0, enabled_ = 0;
  int cycles_ = 0;
  static constexpr double short_settle_s = 0.1;  // standing still before it sits down in a hurry [s]
};

}  // namespace sigmaban

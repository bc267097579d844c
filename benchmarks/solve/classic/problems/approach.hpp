// The ball approach: holonomic, almost non-holonomic, and with a rolling ball.
#pragma once

#include "../references/reference.hpp"
#include "examples/sigmaban/approach/moving_ball.hpp"
#include "examples/sigmaban/approach/winner2016.hpp"

namespace classic {

struct ApproachHa : sigmaban::Approach {
  static constexpr int evaluation_runs = 10'000;
  ApproachHa() : sigmaban::Approach(sigmaban::Approach::ha()) {}
  Reference reference() const { return {{-8.54, 0.036, 10'000}, "dynamic programming, 70 M cells"}; }
};

struct ApproachAnha : sigmaban::Approach {
  static constexpr int evaluation_runs = 10'000;
  ApproachAnha() : sigmaban::Approach(sigmaban::Approach::anha()) {}
  Reference reference() const { return {{-10.98, 0.041, 10'000}, "dynamic programming, 70 M cells"}; }
};

struct RollingBall : sigmaban::MovingBall {
  static constexpr int evaluation_runs = 2000;

  /// The hand-tuned policy for a ball at rest.
  struct Winner {
    sigmaban::Winner2016 still;
    void reset() { still.reset(); }
    Action operator()(const State& s) { return still(s.head<6>()); }
  };
  Reference reference() const { return {evaluated(*this, Winner{}), "Winner2016, made for a ball at rest"}; }
};

}  // namespace classic

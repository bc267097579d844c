// Piecewise cubic Hermite curves with given slopes at the knots; two knots at one time make a break.
#pragma once

#include <array>
#include <cstddef>

namespace sigmaban {

/// A point a curve passes through. The unit of the value is the caller's; times never decrease from knot to knot.
struct Knot {
  double time = 0;
  double value = 0;
  double slope = 0;  // value per time
};

/// The cubic between two knots at `time`. a.time < b.time.
constexpr double hermite(const Knot& a, const Knot& b, double time) {
  const double width = b.time - a.time;
  const double s = (time - a.time) / width, r = 1.0 - s;
  return r * r * ((1.0 + 2.0 * s) * a.value + s * width * a.slope) +
         s * s * ((1.0 + 2.0 * r) * b.value - r * width * b.slope);
}

/// The curve at `time`; beyond its ends, the value at that end. Where two knots share their time, the later one counts,
/// so stretches of no width are never divided by. Linear in the number of knots.
template <std::size_t Count>
constexpr double evaluate_spline(const std::array<Knot, Count>& knots, double time) {
  static_assert(Count >= 1);
  if (!(time >= knots.front().time)) return knots.front().value;
  for (std::size_t i = 1; i < Count; ++i) {
    if (time < knots[i].time) return hermite(knots[i - 1], knots[i], time);
  }
  return knots.back().value;
}

}  // namespace sigmaban

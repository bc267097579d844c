// An axis-aligned box: the bounds of states, actions and search spaces.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"

namespace surefoot {

namespace detail {
/// Throws CoreError unless they are equally many, finite, and low <= high in every dimension.
void check_bounds(std::span<const double> low, std::span<const double> high);
}  // namespace detail

/// Closed box [low, high] in N dimensions, in the units of whatever it bounds. N may be Eigen::Dynamic.
/// A box can only be built valid: finite bounds with low <= high in every dimension, else CoreError.
template <int N>
class Box {
 public:
  Box(Vec<N> low, Vec<N> high) : low_(std::move(low)), high_(std::move(high)) {
    detail::check_bounds({low_.data(), static_cast<std::size_t>(low_.size())},
                         {high_.data(), static_cast<std::size_t>(high_.size())});
  }

  /// The box [-half, half].
  static Box symmetric(const Vec<N>& half) { return Box(-half, half); }

  const Vec<N>& low() const { return low_; }
  const Vec<N>& high() const { return high_; }
  Eigen::Index size() const { return low_.size(); }
  Vec<N> width() const { return high_ - low_; }
  Vec<N> center() const { return 0.5 * (low_ + high_); }

  /// Whether the point lies inside, its faces included. False for a point with a NaN.
  bool contains(const Vec<N>& point) const {
    for (Eigen::Index i = 0; i < point.size(); ++i) {
      if (!(point[i] >= low_[i] && point[i] <= high_[i])) return false;
    }
    return true;
  }

  /// The nearest point of the box.
  Vec<N> clamp(Vec<N> point) const {
    for (Eigen::Index i = 0; i < point.size(); ++i) point[i] = std::min(std::max(point[i], low_[i]), high_[i]);
    return point;
  }

  /// Maps [0,1]^N onto the box, and back (a dimension without width maps back to 0).
  Vec<N> from_unit(const Vec<N>& unit) const { return low_ + unit.cwiseProduct(width()); }
  Vec<N> to_unit(const Vec<N>& point) const {
    Vec<N> unit = point - low_;
    for (Eigen::Index i = 0; i < unit.size(); ++i) unit[i] = high_[i] > low_[i] ? unit[i] / (high_[i] - low_[i]) : 0.0;
    return unit;
  }

  /// A uniform draw.
  Vec<N> sample(Rng& rng) const {
    Vec<N> point = low_;
    for (Eigen::Index i = 0; i < point.size(); ++i) point[i] = rng.uniform(low_[i], high_[i]);
    return point;
  }

 private:
  Vec<N> low_;
  Vec<N> high_;
};

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/core/box.ipp"
#endif

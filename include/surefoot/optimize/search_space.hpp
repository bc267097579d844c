// Box constraints by a smooth change of coordinates: a search without bounds sees the box and nothing else.
//
// A bounded coordinate is searched in units of the box's width. The map from search to user coordinates is the
// identity inside, a parabola within 5 % of the width on either side of a face, which it touches with slope zero, and
// goes on mirrored beyond. So it is onto and smooth, every candidate is feasible, the objective needs no penalty, and
// an optimum on a face is an ordinary minimum for the search. (The method of Hansen's own implementations.) Dimensions
// without width are left out of the search. Cost: linear in the dimension.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/optimize/objective.hpp"

namespace surefoot {

class SearchSpace {
 public:
  /// Of a box, or of all points where there is none.
  explicit SearchSpace(std::optional<Box<Eigen::Dynamic>> box) : box_(std::move(box)) {
    if (!box_) return;
    for (Eigen::Index i = 0; i < box_->size(); ++i) {
      if (box_->width()[i] > 0) free_.push_back(i);
    }
    if (free_.empty()) throw OptimizeError("SearchSpace: the box must have a width in at least one dimension");
  }

  /// What the search has to find for the user's point `x`, which must lie in the box.
  Eigen::VectorXd to_search(const Eigen::VectorXd& x) const {
    if (!box_) return x;
    if (x.size() != box_->size() || !box_->contains(x)) {
      throw OptimizeError("cma_es: the start must lie in the box and have its dimension");
    }
    const Eigen::VectorXd unit = box_->to_unit(x);
    Eigen::VectorXd y(static_cast<Eigen::Index>(free_.size()));
    for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = unfold(unit[free_[static_cast<std::size_t>(i)]]);
    return y;
  }

  /// The user's point for the search's point `y`; always in the box.
  void to_user(const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::VectorXd& x) const {
    if (!box_) {
      x = y;
      return;
    }
    x = box_->low();
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const Eigen::Index at = free_[static_cast<std::size_t>(i)];
      const double low = box_->low()[at], high = box_->high()[at];
      x[at] = std::clamp(low + fold(y[i]) * (high - low), low, high);
    }
  }
  Eigen::VectorXd to_user(const Eigen::Ref<const Eigen::VectorXd>& y) const {
    Eigen::VectorXd x;
    to_user(y, x);
    return x;
  }

 private:
  static constexpr double edge = 0.05;  // half width of the parabola [widths of the box]

  // From the real line to [0, 1].
  static double fold(double y) {
    constexpr double period = 2 + 4 * edge;
    double u = y + edge;  // the map is even around 0 and around half a period
    u = std::abs(u - period * std::round(u / period));
    const double from_face = std::min(u, period / 2 - u);  // from the nearer face, in search coordinates
    const double inside = from_face < 2 * edge ? from_face * from_face / (4 * edge) : from_face - edge;
    return u <= period / 4 ? inside : 1 - inside;
  }

  // The inverse of fold() on [-edge, 1 + edge].
  static double unfold(double unit) {
    const double from_face = std::min(unit, 1 - unit);
    const double y = from_face < edge ? 2 * std::sqrt(edge * from_face) - edge : from_face;
    return unit <= 0.5 ? y : 1 - y;
  }

  std::optional<Box<Eigen::Dynamic>> box_;
  std::vector<Eigen::Index> free_;  // the dimensions with a width
};

}  // namespace surefoot

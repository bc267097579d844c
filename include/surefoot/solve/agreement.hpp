// One action from those that the trees of a policy propose. Where they agree, their mean; where they are of several
// opinions (left or right around an obstacle), the mean of the largest group alone: the mean of all would be an action
// that no tree proposes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/core/vec.hpp"

namespace surefoot {

/// Furthest that two actions are apart, in any dimension, to count as one opinion [half widths of the action box]: half
/// of the way from the middle to a bound, so that full left, nothing and full right are three opinions.
constexpr double same_opinion = 0.5;

/// Distances that differ by less are equal [share]: votes that tie are common (four trees for full left, four for full
/// right), and rounding, other on another machine, must not decide them.
constexpr double tied_distances = 1e-6;

/// The mean of the proposals that agree with the medoid (the one with the least distances to all others, the sum over
/// dimensions of the differences in half widths; of tied ones the first). `proposals`: one action of Dims numbers after
/// the other; `reach`: same_opinion in the unit of each dimension. Cost: as a mean where all agree, else
/// O(count^2 Dims).
template <int Dims>
Vec<Dims> agreed_action(std::span<const double> proposals, const Vec<Dims>& reach) {
  constexpr auto dims = static_cast<std::size_t>(Dims);
  const std::size_t count = proposals.size() / dims;
  Vec<Dims> sum = Vec<Dims>::Zero();
  Vec<Dims> low = Eigen::Map<const Vec<Dims>>(proposals.data());
  Vec<Dims> high = low;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Map<const Vec<Dims>> one(proposals.data() + i * dims);
    sum += one;
    low = low.cwiseMin(one);
    high = high.cwiseMax(one);
  }
  if (((high - low).array() <= reach.array()).all()) return sum * (1.0 / static_cast<double>(count));

  const auto difference = [&](std::size_t a, std::size_t b, std::size_t d) {
    return std::abs(proposals[a * dims + d] - proposals[b * dims + d]);
  };
  std::size_t medoid = 0;
  double least = 0;
  for (std::size_t i = 0; i < count; ++i) {
    double distances = 0;
    for (std::size_t j = 0; j < count; ++j) {
      for (std::size_t d = 0; d < dims; ++d) {
        const double span = reach[static_cast<int>(d)];
        distances += span > 0 ? difference(i, j, d) / span : 0;
      }
    }
    if (i == 0 || distances < least * (1 - tied_distances)) {
      medoid = i;
      least = distances;
    }
  }
  sum.setZero();
  double agreeing = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bool near = true;
    for (std::size_t d = 0; d < dims; ++d) near = near && difference(i, medoid, d) <= reach[static_cast<int>(d)];
    if (!near) continue;
    sum += Eigen::Map<const Vec<Dims>>(proposals.data() + i * dims);
    agreeing += 1;
  }
  return sum * (1.0 / agreeing);
}

}  // namespace surefoot

// How much noise confuses the order of the candidates, which is all that an evolution strategy learns from.
// After the uncertainty handling of Hansen, Niederberger, Guzzella, Koumoutsakos: "A method for handling uncertainty in
// evolutionary optimization with an application to feedback control of combustion", IEEE TEC 13 (2009). There some
// candidates are evaluated twice and changes of rank counted; here every candidate's evaluations are split into two
// halves, which costs nothing extra, and the ranks by one half are compared with those by the other. An offset that
// all candidates share (common random numbers) does not disturb it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace surefoot {

/// How a noisy objective is evaluated: each candidate's value is the mean of several evaluations. Where two halves of
/// them disagree about the ranks by more than `disorder`, the number of evaluations grows; else it slowly falls back.
struct NoiseOptions {
  int evaluations = 1;      // of each candidate, at first and at least
  int max_evaluations = 1;  // of each candidate; the same as `evaluations` keeps the number fixed
  double disorder = 0.35;   // see rank_disorder()
  double growth = 1.5;      // factor per generation
  // Whether all candidates of a generation meet the same random numbers: differences then have far less noise
  // wherever a random number has about the same effect on all of them. The next generation meets other ones.
  bool common_random_numbers = true;
};

/// Mean change of rank between two evaluations of the same candidates, over that of a random shuffle (Spearman's
/// footrule): 0 for equal orders, about 1 for pure noise. Values that are not finite rank last.
inline double rank_disorder(std::span<const double> first, std::span<const double> second) {
  const auto ranks = [](std::span<const double> values) {
    std::vector<std::size_t> order(values.size()), rank(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto value = [&](std::size_t i) {
      return std::isfinite(values[i]) ? values[i] : std::numeric_limits<double>::infinity();
    };
    std::ranges::sort(
        order, [&](std::size_t a, std::size_t b) { return value(a) < value(b) || (value(a) == value(b) && a < b); });
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    return rank;
  };
  const std::vector<std::size_t> a = ranks(first), b = ranks(second);
  double change = 0;
  for (std::size_t i = 0; i < a.size(); ++i) change += std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
  const auto count = static_cast<double>(a.size());
  return change / ((count * count - 1) / 3);
}

}  // namespace surefoot

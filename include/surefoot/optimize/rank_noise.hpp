// Disorder that noise brings into the ranks of the candidates, which are all that an evolution strategy learns from.
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
double rank_disorder(std::span<const double> first, std::span<const double> second);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/rank_noise.ipp"
#endif

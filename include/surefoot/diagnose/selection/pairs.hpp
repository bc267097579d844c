// Pairs of proposals: what two effects would explain together, where neither shows alone.
#pragma once

#include <cstddef>
#include <vector>

#include "surefoot/diagnose/selection/propose.hpp"

namespace surefoot::diagnosis {

/// Two proposals with the parameters to start them from, and the share of the squared residuals that they explain
/// together, by the linear prediction.
struct ProposedPair {
  Proposal first, second;
  double gain = 0;
};

/// The pairs with the largest gains, best first, each in its best form only: more of them would crowd others out. Cost:
/// the square of the number of signatures, times their length.
std::vector<ProposedPair> propose_pairs(const std::vector<Proposal>& proposals, std::size_t count);

/// The same of pairs of one effect in one form at two places.
std::vector<ProposedPair> propose_tied_pairs(const std::vector<Proposal>& proposals, std::size_t count);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/pairs.ipp"
#endif

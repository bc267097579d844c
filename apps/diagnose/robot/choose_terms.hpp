// The choice of terms: which sets of a linear model are the most probable. No MuJoCo here.
#pragma once

#include "linear_model.hpp"

namespace diagnose_robot {

struct ChoiceCriteria {
  /// -2 log of the odds that a term is needed before it is taken: odds of 20, as for the diagnosis of one joint.
  double needed = 5.99;
  /// The same before a term takes the place of another: odds of 3, so that twins do not take turns.
  double better = 2.2;
  int most_new = 3;  // terms that one linearization may add; farther off, it no longer holds
};

/// Adds and takes away terms of `allowed` until neither makes the set more probable.
TermSet choose_terms(const LinearModel& model, TermSet set, const TermSet& allowed,
                     const ChoiceCriteria& criteria = {});

/// -2 log of the odds for having the term, the others fitted again; by term, NaN where it is not in the set.
Eigen::VectorXd evidence_of_terms(const LinearModel& model, const TermSet& set);

/// What terms take off the errors of the joints that they act on, on blocks that were not used to fit; by term, NaN
/// where it is not in the set.
struct HeldOutGain {
  Eigen::VectorXd share;  // of the root mean square error
  Eigen::VectorXd taken;  // root mean square of what goes, in the unit of the errors
};

HeldOutGain held_out_gain(const LinearModel& model, const TermSet& set);

struct TermAlternative {
  Eigen::Index instead = 0, other = 0;  // terms
  double criterion = 0;                 // -2 log of the odds against it
};

/// For each term of the set those outside that would do as well, within odds of 8.
std::vector<TermAlternative> alternatives_of(const LinearModel& model, const TermSet& set, const TermSet& allowed);

}  // namespace diagnose_robot

// The choice of terms: which sets of a linear model are the most probable. No MuJoCo here.
#pragma once

#include "linear_model.hpp"

namespace diagnose_robot {

struct ChoiceCriteria {
  /// -2 log of the odds that a term is needed before it is taken: odds of 20, as for the diagnosis of one joint.
  double needed = 5.99;
  /// The same before a term takes the place of another: odds of 3, so that twins do not take turns.
  double better = 2.2;
  int tried = 6;                // terms, the most probable first, that held-out blocks may show to be worth too little
  int paired = 20;              // terms, the most probable first, that are tried together with another one
  double smallest_gain = 0.02;  // of the error of its joints on held-out blocks that a term must take away, as for one
                                // joint
  int most_new = 3;             // terms that one linearization may add; farther off, it no longer holds
};

/// Adds and takes away terms of `allowed` until neither makes the set more probable.
TermSet choose_terms(const LinearModel& model, TermSet set, const TermSet& allowed,
                     const ChoiceCriteria& criteria = {});

/// -2 log of the odds for `with` against `without`, which has fewer terms: the posterior probability, averaged over
/// blocks and joints that are drawn anew (Bayesian bootstrap), so that what a few of them alone decide stays uncertain.
/// As many errors count as are independent in what `with` leaves.
double evidence_between(const LinearModel& model, const TermSet& with, const TermSet& without);

/// The same for having each term, the others fitted again; NaN where it is not in the set.
Eigen::VectorXd evidence_of_terms(const LinearModel& model, const TermSet& set);

/// What a term takes off the errors of the joints that it acts on, on blocks that were not used to fit.
struct HeldOutGain {
  double share = 0;  // of the root mean square error
  double taken = 0;  // root mean square of what goes, in the unit of the errors
};

HeldOutGain held_out_gain(const LinearModel& model, const TermSet& set, Eigen::Index term);

/// How much more a term of the set is worth than it must be, by the strictest of: its share of the errors on held-out
/// blocks, what it takes away against the difference of two simulations of one model, and the evidence for it.
double worth_of(const LinearModel& model, const TermSet& set, Eigen::Index term, const ChoiceCriteria& criteria = {});

/// The same against what nothing explains at the joints that the term acts on, their errors beyond `noise` (by joint):
/// no formula is quite that of the machine, and what takes less than 5 % off such errors may as well be a part of them.
double worth_beside_unexplained(const LinearModel& model, const TermSet& set, Eigen::Index term,
                                const Eigen::VectorXd& noise);

struct TermAlternative {
  Eigen::Index instead = 0, other = 0;  // terms
  double criterion = 0;                 // -2 log of the odds against it
};

/// Whether two terms explain the same errors: beside the one of the set, the other is worth less than half of what the
/// first is. Terms that explain as much, but elsewhere, are no tie.
bool explain_the_same(const LinearModel& model, const TermSet& set, const TermAlternative& tie);

/// For each term of the set those outside that would do as well, within odds of 8.
std::vector<TermAlternative> alternatives_of(const LinearModel& model, const TermSet& set, const TermSet& allowed);

}  // namespace diagnose_robot

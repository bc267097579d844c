// The search for what a robot's model leaves out: linearize, choose terms, move there; groups first, single joints
// then.
#pragma once

#include <functional>
#include <string>

#include "choose_terms.hpp"
#include "linearize.hpp"

namespace diagnose_robot {

struct SearchCriteria {
  int most_rounds = 60;   // each one linearization, most of few terms
  int most_halvings = 5;  // of a step that raises the errors
  double smallest_gain =
      0.02;  // of the error on held-out blocks of its joints that a term must take away: as for one joint
  double times_numerical = 2;  // the difference of two simulations of one model: what a term takes away must be more
  double settled = 0.05;       // decrease of the criterion below which parameters no longer move
};

struct SearchResult {
  Eigen::VectorXd theta;
  TermSet set;
  Eigen::MatrixXd errors;  // at theta
  LinearModel linear;      // at theta, of all terms
  bool complete = true;
  std::vector<std::string> dropped;  // terms that held-out blocks did not want, as sentences
};

using Progress = std::function<void(const std::string& stage, double share)>;

SearchResult search_terms(const Evidence& evidence, const Progress& progress, const SearchCriteria& criteria = {});

}  // namespace diagnose_robot

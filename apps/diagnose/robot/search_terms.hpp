// The search for what a robot's model leaves out: linearize, choose terms, move there.
#pragma once

#include <functional>
#include <string>

#include "choose_terms.hpp"
#include "linearize.hpp"

namespace diagnose_robot {

struct SearchCriteria {
  int most_rounds = 60;  // each one linearization, most of few terms
};

struct SearchResult {
  Eigen::VectorXd theta;
  TermSet set;
  std::vector<StartState> starts;  // of recordings
  Eigen::MatrixXd errors;          // at theta and starts
  LinearModel linear;      // at theta, of all terms
  bool complete = true;
  Eigen::VectorXd numerical;         // by joint, as of Evidence, lowered to what the recordings leave room for
  std::vector<std::string> dropped;  // terms that held-out blocks did not want, as sentences
};

using Progress = std::function<void(const std::string& stage, double share)>;

SearchResult search_terms(const Evidence& evidence, const Progress& progress, const SearchCriteria& criteria = {});

}  // namespace diagnose_robot

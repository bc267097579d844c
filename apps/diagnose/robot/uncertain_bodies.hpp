// Intervals of what was found, where masses and inertias of the links are only roughly as the model states them.
#pragma once

#include "search_terms.hpp"

namespace diagnose_robot {

struct UncertainBodies {
  Eigen::VectorXd standard_errors;      // by term that is there, or of `others`, each beside those that are
  std::vector<Eigen::Index> like_link;  // terms of rotor inertia that do what more inertia of their link would do
};

/// Unless bodies are calibrated, mass, centre of mass and inertia of every link are uncertain by some 10 % (see
/// term_priors.cpp). `others`: terms that are not there. Cost: one linearization.
UncertainBodies allow_for_bodies(const Evidence& evidence, const SearchResult& found,
                                 const std::vector<Eigen::Index>& others = {});

}  // namespace diagnose_robot

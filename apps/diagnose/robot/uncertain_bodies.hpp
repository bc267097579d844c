// Intervals of what was found, where masses and inertias of the links are only roughly as the model states them.
#pragma once

#include "search_terms.hpp"

namespace diagnose_robot {

/// Standard errors by term. Unless bodies are calibrated, mass, centre of mass and inertia of every link are uncertain
/// by some 10 % (see linearize.cpp), so that the inertia of a rotor is no better known than that of the link behind it.
Eigen::VectorXd standard_errors_with_bodies(const Evidence& evidence, const SearchResult& found);

}  // namespace diagnose_robot

// The face of surefoot/solve, but for policy search, and what it stands on: policies from a simulator.
//
// policy_search.hpp is not here: it brings CMA-ES with Eigen's eigenvalues, which would double what a program that only
// trains costs to compile.
#pragma once

#include "surefoot/core.hpp"
#include "surefoot/core/validate.hpp"
#include "surefoot/forest.hpp"
#include "surefoot/solve/export_policy.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi.hpp"

// All of surefoot/solve, and what it stands on: policies from a simulator.
#pragma once

#include "surefoot/core.hpp"
#include "surefoot/forest.hpp"
#include "surefoot/optimize.hpp"
#include "surefoot/solve/export_policy.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/lookahead.hpp"
#include "surefoot/solve/policy_search.hpp"
#include "surefoot/solve/rfpi.hpp"
#include "surefoot/solve/rfpi_backup.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/rfpi_rollouts.hpp"
#include "surefoot/solve/rfpi_state.hpp"
#include "surefoot/solve/visited_states.hpp"

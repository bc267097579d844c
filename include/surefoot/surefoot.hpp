// The face of all areas, for users, but for what needs MPI. The header of an area, surefoot/solve.hpp say, compiles much
// faster. The library's own headers include none of these.
#pragma once

#include "surefoot/core.hpp"
#include "surefoot/core/validate.hpp"
#include "surefoot/diagnose.hpp"
#include "surefoot/forest.hpp"
#include "surefoot/motion.hpp"
#include "surefoot/motion/walk_changes.hpp"
#include "surefoot/optimize.hpp"
#include "surefoot/solve.hpp"
#include "surefoot/solve/policy_search.hpp"
#include "surefoot/version.hpp"

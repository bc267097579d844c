// The face of surefoot/core, but for validate.hpp: problems, policies, executors, random numbers, rollouts.
//
// validate.hpp (checks of a problem) is not here but in solve.hpp: only those who write a problem need it, and it would
// cost all others 30 MB to compile.
#pragma once

#include "surefoot/core/any_executor.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/core/box.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/function_ref.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/portable.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/core/transition.hpp"
#include "surefoot/core/vec.hpp"

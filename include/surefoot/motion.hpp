// The face of surefoot/motion, but for walk_changes.hpp, and what it stands on: how a robot really walks.
//
// walk_changes.hpp (what changed between two walks) is not here: a program that only calibrates would compile a quarter
// longer with it.
#pragma once

#include "surefoot/core.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/compare.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/monitor.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/one_sided_correction.hpp"
#include "surefoot/motion/outliers.hpp"
#include "surefoot/motion/plan.hpp"
#include "surefoot/motion/previous_command_correction.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "surefoot/motion/walk_sequence.hpp"
#include "surefoot/optimize.hpp"

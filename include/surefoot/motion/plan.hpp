// Plans of calibration experiments: commands to walk, those that tell most, and how many sequences are worth walking.
#pragma once

#include "surefoot/motion/plan/command_plan.hpp"
#include "surefoot/motion/plan/informative_commands.hpp"
#include "surefoot/motion/plan/learning_curve.hpp"

// The subcommands of the program. Each adds itself with its options; it runs when the command line names it.
#pragma once

#include "../common/command.hpp"
#include "../common/usage_error.hpp"

namespace calibrate_program {

using example::Interrupted;
using example::UsageError;

void add_fit(example::Command& program);
void add_curve(example::Command& program);
void add_plan(example::Command& program);
void add_sheet(example::Command& program);
void add_update(example::Command& program);
void add_compare(example::Command& program);
void add_simulate(example::Command& program);

}  // namespace calibrate_program

// The subcommands of the program. Each adds itself with its options; it runs when the command line names it.
#pragma once

#include <CLI/CLI.hpp>

#include "../common/usage_error.hpp"

namespace calibrate_program {

using example::Interrupted;
using example::UsageError;

void add_fit(CLI::App& program);
void add_curve(CLI::App& program);
void add_plan(CLI::App& program);
void add_sheet(CLI::App& program);
void add_update(CLI::App& program);
void add_compare(CLI::App& program);
void add_simulate(CLI::App& program);

}  // namespace calibrate_program

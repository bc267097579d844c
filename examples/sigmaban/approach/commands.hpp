// The subcommands of the program. Each adds itself with its options; it runs when the command line names it.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

#include "../../../apps/common/usage_error.hpp"
#include "approach.hpp"

namespace sigmaban {

using example::Interrupted;
using example::UsageError;

void add_train(CLI::App& program);
void add_tune(CLI::App& program);
void add_evaluate(CLI::App& program);
void add_trajectories(CLI::App& program);
void add_export(CLI::App& program);
void add_table(CLI::App& program);

/// The option --problem ha|anha.
inline void add_problem_option(CLI::App& command, std::string& problem) {
  command.add_option("--problem", problem, "ha: holonomic approach; anha: almost non-holonomic approach")
      ->required()
      ->check(CLI::IsMember({"ha", "anha"}));
}

/// The option --threads.
inline void add_threads_option(CLI::App& command, std::size_t& threads) {
  command.add_option("--threads", threads, "0: as many as the machine has; results do not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

}  // namespace sigmaban

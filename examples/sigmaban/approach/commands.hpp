// The subcommands of the program. Each adds itself with its options; it runs when the command line names it.
#pragma once

#include <cstddef>
#include <string>

#include "../../../apps/common/command.hpp"
#include "../../../apps/common/usage_error.hpp"
#include "approach.hpp"

namespace sigmaban {

using example::Interrupted;
using example::UsageError;

void add_train(example::Command& program);
void add_tune(example::Command& program);
void add_evaluate(example::Command& program);
void add_trajectories(example::Command& program);
void add_export(example::Command& program);
void add_table(example::Command& program);

/// The option --problem ha|anha.
inline void add_problem_option(example::Command& command, std::string& problem) {
  command.add_option("--problem", problem, "ha: holonomic approach; anha: almost non-holonomic approach")
      ->required()
      ->check(example::one_of({"ha", "anha"}));
}

/// The option --threads.
inline void add_threads_option(example::Command& command, std::size_t& threads) {
  command.add_option("--threads", threads, "0: as many as the machine has; results do not depend on it")
      ->check(example::between(0, 1024))
      ->capture_default_str();
}

}  // namespace sigmaban

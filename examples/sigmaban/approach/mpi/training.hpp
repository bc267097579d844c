// Training on many processes.
#pragma once

#include <CLI/CLI.hpp>

#include "surefoot/mpi/mpi_session.hpp"

namespace sigmaban {

/// Adds `train`; all processes of the session work on it.
void add_training(CLI::App& program, surefoot::MpiSession& session);

}  // namespace sigmaban

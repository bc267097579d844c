// Training on many processes.
#pragma once

#include "../../../../apps/common/command.hpp"
#include "surefoot/mpi/mpi_session.hpp"

namespace sigmaban {

/// Adds `train`; all processes of the session work on it.
void add_training(example::Command& program, surefoot::MpiSession& session);

}  // namespace sigmaban

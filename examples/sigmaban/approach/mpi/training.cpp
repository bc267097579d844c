#include "training.hpp"

#include <filesystem>
#include <memory>
#include <string>

#include "../train.hpp"
#include "surefoot/mpi/mpi_executor.hpp"

namespace sigmaban {

void add_training(example::Command& program, surefoot::MpiSession& session) {
  const auto make_executor = [&session](const TrainOptions& options) {
    session.when_lost([checkpoint = options.checkpoint()] {
      const bool saved = std::filesystem::exists(checkpoint);
      return "sigmaban_approach_mpi: ended from outside: a process of this run was lost, or mpirun was told to end; " +
             (saved ? "the same command with --resume goes on from " + checkpoint.string()
                    : "there was no " + checkpoint.string() + " yet, start again");
    });
    return std::make_unique<surefoot::MpiExecutor>(MPI_COMM_WORLD, options.threads);
  };
  add_train_by(program, 1, [make_executor](const TrainOptions& options) { train_on(options, make_executor); });
}

}  // namespace sigmaban

// sigmaban_approach_mpi: the training of sigmaban_approach on many processes, on one machine or on several:
//   mpirun -n 8 sigmaban_approach_mpi train --problem ha --budget 1000 --out ha.policy
// Same options, same bits. If a process is lost, the others end; the same command with --resume goes on.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>

#include "../../../../apps/common/run_program.hpp"
#include "../train.hpp"
#include "surefoot/mpi/mpi_executor.hpp"
#include "surefoot/mpi/mpi_session.hpp"

int main(int argc, char** argv) {
  surefoot::MpiSession session(argc, argv);
  const auto make_executor = [&session](const sigmaban::TrainOptions& options) {
    session.when_lost([checkpoint = options.checkpoint()] {
      const bool saved = std::filesystem::exists(checkpoint);
      return "sigmaban_approach_mpi: ended from outside: a process of this run was lost, or mpirun was told to end; " +
             (saved ? "the same command with --resume goes on from " + checkpoint.string()
                    : "there was no " + checkpoint.string() + " yet, start again");
    });
    return surefoot::MpiExecutor(MPI_COMM_WORLD, options.threads);
  };
  CLI::App program{"Policies for the ball approach of the humanoid robot Sigmaban, on many processes",
                   "sigmaban_approach_mpi"};
  program.require_subcommand(1);
  sigmaban::add_train_on(program, 1, make_executor);

  // All processes read the same command line; one of them talks.
  std::ostringstream words;
  std::streambuf* const errors = std::cerr.rdbuf(words.rdbuf());
  std::streambuf* const output = session.first() ? std::cout.rdbuf() : std::cout.rdbuf(nullptr);
  const int code = example::run_program(program, argc, argv);
  std::cerr.rdbuf(errors);
  std::cout.rdbuf(output);
  return session.end(code, words.str());
}

// sigmaban_approach_mpi: the training of sigmaban_approach on many processes, on one machine or on several:
//   mpirun -n 8 sigmaban_approach_mpi train --problem ha --budget 1000 --out ha.policy
// Same options, same bits. If a process is lost, the others end; the same command with --resume goes on.
#include <iostream>
#include <sstream>

#include "../../../../apps/common/command.hpp"
#include "surefoot/mpi/mpi_session.hpp"
#include "training.hpp"

int main(int argc, char** argv) {
  surefoot::MpiSession session(argc, argv);
  example::Command program{"Policies for the ball approach of the humanoid robot Sigmaban, on many processes",
                           "sigmaban_approach_mpi"};
  program.require_subcommand(1);
  sigmaban::add_training(program, session);

  // All processes read the same command line; one of them talks.
  std::ostringstream words;
  std::streambuf* const errors = std::cerr.rdbuf(words.rdbuf());
  std::streambuf* const output = session.first() ? std::cout.rdbuf() : std::cout.rdbuf(nullptr);
  const int code = example::run_program(program, argc, argv);
  std::cerr.rdbuf(errors);
  std::cout.rdbuf(output);
  return session.end(code, words.str());
}

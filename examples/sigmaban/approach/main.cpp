// sigmaban_approach: trains, tunes, evaluates, draws and exports policies of the ball approach.
// After Ctrl-C the best is kept.

#include "../../../apps/common/command.hpp"
#include "commands.hpp"

int main(int argc, char** argv) {
  example::Command program{"Policies for the ball approach of the humanoid robot Sigmaban", "sigmaban_approach"};
  program.require_subcommand(1);
  sigmaban::add_train(program);
  sigmaban::add_tune(program);
  sigmaban::add_evaluate(program);
  sigmaban::add_trajectories(program);
  sigmaban::add_export(program);
  sigmaban::add_table(program);
  return example::run_program(program, argc, argv);
}

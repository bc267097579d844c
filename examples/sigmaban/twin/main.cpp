// surefoot-twin: a walking robot in MuJoCo that stands in for a real one.

#include "../../../apps/common/command.hpp"
#include "commands.hpp"

namespace {

constexpr const char* usage = R"(Example: record the robot, calibrate it, train for it, see how the policy does on it.
  surefoot-twin record --sequences 60 --seed 1 --out walks.csv
  surefoot-calibrate fit --steps-per-cycle 2 --out walk walks.csv
  sigmaban_approach train --problem ha --motion walk/motion.json --out ball.policy
  surefoot-twin play --problem ha --motion walk/motion.json --policy ball.policy)";

}  // namespace

int main(int argc, char** argv) {
  example::Command program{"A humanoid robot walking in MuJoCo, in place of a real one", "surefoot-twin"};
  program.require_subcommand(1);
  program.footer(usage);
  sigmaban::add_record(program);
  sigmaban::add_gains(program);
  sigmaban::add_stability(program);
  sigmaban::add_play(program);
  sigmaban::add_picture(program);
  sigmaban::add_table4(program);
  return example::run_program(program, argc, argv, "stopped; what was done until then is kept");
}

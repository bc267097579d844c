#include "../robot/run_robot.hpp"

#include "surefoot/core/error.hpp"

namespace diagnose_robot {
namespace {

[[noreturn]] void refuse() {
  throw surefoot::DiagnoseError(
      "this program was built without MuJoCo and reads no robots; install libmujoco-dev or configure with "
      "-D MUJOCO_DIR=FOLDER and build it again");
}

}  // namespace

int run_robot(const diagnose_program::CommandLine&) { refuse(); }
int run_setup(int, const char* const*) { refuse(); }

}  // namespace diagnose_robot

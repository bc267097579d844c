// surefoot-diagnose: says what physics a model leaves out of what recordings show.
// Exit codes: 0 a verdict was reached, 1 a defect of this program, 2 wrong options or files, 130 stopped by Ctrl-C.
#include <iostream>
#include <string_view>

#include "equations.hpp"
#include "robot/run_robot.hpp"
#include "run.hpp"
#include "surefoot/core/error.hpp"

namespace {

template <surefoot::Simulator S>
int diagnose_model(const S& simulator, const diagnose_program::Layout& layout,
                   const diagnose_program::CommandLine& line, const diagnose_program::ModelFile& model) {
  return run(simulator.info(), surefoot_apps::diagnose_function(simulator), layout, line, &model);
}

int diagnose_model_file(const diagnose_program::CommandLine& line) {
  using namespace diagnose_program;
  if (diagnose_robot::is_robot_model(line.model)) return diagnose_robot::run_robot(line);
  const ModelFile model = read_model_file(line.model);
  const Layout layout = layout_of(model);
  const auto work = [&](const auto& simulator) { return diagnose_model(simulator, layout, line, model); };
  return layout.ode ? with_ode_model(model, work) : work(MapModel(model));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "setup") {
    try {
      return diagnose_robot::run_setup(argc, argv);
    } catch (const surefoot::Error& error) {
      std::cerr << "surefoot-diagnose: " << error.what() << '\n';
      return diagnose_program::exit_wrong_input;
    }
  }
  return diagnose_program::guarded(argc, argv, true, diagnose_model_file);
}

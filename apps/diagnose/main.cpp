// surefoot-diagnose: says what physics a model leaves out of what recordings show.
// Exit codes: 0 a verdict was reached, 1 a defect of this program, 2 wrong options or files, 130 stopped by Ctrl-C.
#include "equations.hpp"
#include "own_simulator.hpp"

namespace {

int diagnose_model(const diagnose_program::CommandLine& line) {
  using namespace diagnose_program;
  const ModelFile model = read_model_file(line.model);
  const Layout layout = layout_of(model);
  if (layout.ode) return run(OdeModel(model), layout, line, &model);
  return run(MapModel(model), layout, line, &model);
}

}  // namespace

int main(int argc, char** argv) { return diagnose_program::guarded(argc, argv, true, diagnose_model); }

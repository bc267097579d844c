// Joint targets that were read are held against our walk engine, whatever settings they name.
#include <sstream>

#include "examples/sigmaban/robot/walk_engine/compare_with_reference.hpp"
#include "examples/sigmaban/robot/walk_engine/reference_file.hpp"
#include "examples/sigmaban/robot/walk_engine/spline_walk.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/text_of.hpp"

void fuzz::reference(Input input) {
  using namespace sigmaban;
  std::istringstream file(text_of(input));
  accepted<ReferenceError>([&] {
    compare_with_reference(read_reference(file), [](const WalkParameters& parameters, double phase) {
      return SplineWalk(parameters, phase);
    });
  });
}

// Holds our walk engine against a file of joint targets: walk_engine_check FILE.csv
#include "walk_engine/check_engine.hpp"
#include "walk_engine/spline_walk.hpp"

int main(int argc, char** argv) {
  return sigmaban::check_engine(argc, argv, [](const sigmaban::WalkParameters& parameters, double phase) {
    return sigmaban::SplineWalk(parameters, phase);
  });
}

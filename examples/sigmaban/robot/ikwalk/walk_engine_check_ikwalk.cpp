// The same for the engine of team Rhoban, where it is at hand: walk_engine_check_ikwalk FILE.csv
#include "../walk_engine/check_engine.hpp"
#include "../walk_engine/ikwalk_adapter.hpp"

int main(int argc, char** argv) {
  return sigmaban::check_engine(argc, argv, [](const sigmaban::WalkParameters& parameters, double phase) {
    return sigmaban::IkWalkAdapter(parameters, phase);
  });
}

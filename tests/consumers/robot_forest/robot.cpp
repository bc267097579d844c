// On the robot: loads the forest and asks it. Fails unless it has learnt what it was taught.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "answers.hpp"
#include "surefoot/forest/serialize.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const auto forest = surefoot::load<TorqueForest>(std::filesystem::path(argv[1]));
    const double torque = forest.predict(surefoot::Vec<2>(1.0, 2.0))[0];
    std::printf("%.2f N m at 1 rad and 2 rad/s\n", torque);
    const double taught = 2 * std::sin(1.0) + 0.1 * 2.0;
    return std::abs(torque - taught) < 0.1 && write_answers(forest, argv[2]) ? 0 : 1;
  } catch (const surefoot::ForestError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

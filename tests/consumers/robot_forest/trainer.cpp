// On the desk: learns the torque that holds an arm against gravity and friction, and writes it for the robot.
#include <cmath>
#include <filesystem>

#include "answers.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/serialize.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  surefoot::Dataset<2, 1> samples;
  constexpr int count = 2000;
  samples.inputs.resize(2, count);
  samples.outputs.resize(1, count);
  surefoot::Rng rng(1);
  for (int i = 0; i < count; ++i) {
    const double angle = rng.uniform(-1.5, 1.5), speed = rng.uniform(-3, 3);
    samples.inputs.col(i) = Eigen::Vector2d(angle, speed).cast<float>();
    samples.outputs(0, i) = 2 * std::sin(angle) + 0.1 * speed;
  }
  const auto forest = surefoot::train_extra_trees<MiddleLeaf>(samples, {.trees = 10}, surefoot::Threads{}, /*seed*/ 1);
  surefoot::save(forest, std::filesystem::path(argv[1]));
  return write_answers(forest, argv[2]) ? 0 : 1;
}

// A user of forests: trains one, asks it and saves it.
#include "surefoot/forest.hpp"

#include <cmath>
#include <cstdio>

int main() {
  surefoot::Dataset<2, 1> samples;
  samples.inputs.setRandom(2, 2000);
  samples.outputs.resize(1, 2000);
  for (Eigen::Index i = 0; i < 2000; ++i) {
    samples.outputs(0, i) = std::sin(3 * samples.inputs(0, i)) + samples.inputs(1, i);
  }
  const auto forest = surefoot::train_extra_trees<surefoot::LinearLeaf>(samples, {.trees = 10}, surefoot::Threads{},
                                                                        /*seed*/ 1);
  std::printf("%.3f\n", forest.predict(surefoot::Vec<2>(0.5, 0.2))[0]);
  surefoot::save(forest, "forest.bin");
}

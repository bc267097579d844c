// For callgrind: instructions per warm prediction of a forest with 25 trees of 200 leaves. Prints how many predictions
// run inside predict_all_points, the function to collect in.
#include <cstddef>
#include <cstdio>
#include <vector>

#include "samples.hpp"
#include "surefoot.hpp"

namespace {

constexpr std::size_t points = 4096;

[[gnu::noinline]] void predict_all_points(peers::Model& model, std::vector<double>& out) {
  for (std::size_t i = 0; i < points; ++i) model.predict_one(i, &out[i]);
}

}  // namespace

int main() {
  const auto model = peers::train_constant(peers::make_samples(1, 11'400, 1), {.leaves = 200, .min_leaf = 2});
  model->keep(peers::make_samples(1, points, 3).x);
  std::vector<double> out(points);
  predict_all_points(*model, out);
  std::printf("%zu\n", points);
}

// What smaller policies learn from: runs of the larger one, and of smaller ones.
#include "examples/sigmaban/approach/distill.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>

#include "examples/sigmaban/approach/approach.hpp"
#include "surefoot/solve/rfpi.hpp"

using namespace sigmaban;

TEST_CASE("a smaller policy that was shown how to go on from where it goes stays closer to the larger one there") {
  const Approach problem = Approach::ha();
  const surefoot::Serial serial;
  surefoot::RfpiOptions options;
  options.budget.counted_seconds = 2;
  const auto policy = surefoot::rfpi(problem, options, serial, 1).policy;
  // Mean square distance to the larger policy's action along its own runs, in widths of the action box.
  const auto distance = [&](const DistillOptions& distill) {
    constexpr int leaves = 800;
    const auto data = demonstrations_to_imitators(policy, leaves, distill, serial, 1);
    const auto small = imitate(problem, data, leaves, distill, serial, 1);
    const auto shown = demonstrations(policy, small, {.runs = 2000}, serial, 2);
    Eigen::Matrix<double, Approach::action_dim, Eigen::Dynamic> own;
    small.forest().predict(shown.inputs, own);
    const auto width = problem.action_box().width();
    return ((own - shown.outputs).array().colwise() / width.array()).square().mean();
  };
  CHECK(distance({.runs = 2000, .rounds = 2}) < 0.95 * distance({.runs = 6000, .rounds = 0}));
}

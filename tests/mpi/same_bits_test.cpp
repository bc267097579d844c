// What runs on executors gives the same bits on several processes as on one thread.
#include <doctest/doctest.h>

#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/forest/distill.hpp"
#include "surefoot/forest/permutation_importance.hpp"
#include "surefoot/forest/prune.hpp"
#include "surefoot/forest/training_report.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/compare.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/plan.hpp"
#include "surefoot/mpi/mpi_executor.hpp"
#include "surefoot/solve/policy_search.hpp"
#include "tests/forest/samples.hpp"
#include "tests/support/pendulum.hpp"
#include "tests/support/walks.hpp"

namespace surefoot {
namespace {

struct Feedback {
  Vec<2> gains;
  Vec<1> operator()(const Vec<2>& state) const { return Vec<1>(-gains.dot(state)); }
};

TEST_CASE("the value of a policy") {
  const MpiExecutor executor(MPI_COMM_WORLD);
  const Feedback policy{{2, 0.5}};
  for (const int runs : {1, 64, 1000}) {
    const RolloutOptions options{.runs = runs, .horizon = 30};
    CHECK(returns(toy::Pendulum{}, policy, options, executor, 1) ==
          returns(toy::Pendulum{}, policy, options, Serial{}, 1));
  }
}

TEST_CASE("a policy search") {
  const MpiExecutor executor(MPI_COMM_WORLD);
  const PolicySearchOptions options{
      .horizon = 20, .min_runs = 4, .max_runs = 16, .total_runs = 3000, .final_runs = 200};
  const auto search = [&](const auto& on) {
    const auto make = [](const Vec<2>& gains) { return Feedback{gains}; };
    return policy_search(toy::Pendulum{}, make, Vec<2>(4, 1), Box<2>{Vec<2>(0, 0), Vec<2>(5, 5)}, options, on, 1);
  };
  const auto serial = search(Serial{}), together = search(executor);
  CHECK(together.parameters == serial.parameters);
  CHECK(together.value.mean == serial.value.mean);
  CHECK(together.runs == serial.runs);
}

TEST_CASE("forests: trained, pruned, distilled, and judged") {
  const MpiExecutor executor(MPI_COMM_WORLD);
  const auto samples = toy::sample(toy::ClippedLaws{}, 3000, 1, 0.1);
  const ExtraTreesOptions options{.trees = 7, .bootstrap = true};
  const auto serial = train_with_report<LinearLeaf>(samples, options, Serial{}, 1);
  const auto together = train_with_report<LinearLeaf>(samples, options, executor, 1);
  CHECK(together.forest == serial.forest);
  CHECK(together.importance == serial.importance);
  CHECK(together.out_of_bag->rmse == serial.out_of_bag->rmse);
  CHECK(together.out_of_bag->covered == serial.out_of_bag->covered);
  const std::size_t half = serial.forest.bytes() / 2;
  CHECK(prune(serial.forest, samples, half, {}, executor) == prune(serial.forest, samples, half, {}, Serial{}));
  const DistillOptions small{.trees = 3, .points = 2000};
  CHECK(distill(serial.forest, samples.inputs, small, executor, 1).forest ==
        distill(serial.forest, samples.inputs, small, Serial{}, 1).forest);
  CHECK(permutation_importance(serial.forest, samples, executor, 1).mean ==
        permutation_importance(serial.forest, samples, Serial{}, 1).mean);
  const ExtraTreesOptions inlined{.trees = 3};
  const auto cliff = toy::sample(toy::Cliff{}, 500, 1);
  CHECK(train_extra_trees<ConstantLeaf>(cliff, inlined, executor, 1) ==
        train_extra_trees<ConstantLeaf>(cliff, inlined, Serial{}, 1));
}

TEST_CASE("cross-validation of motion models, a learning curve, and a choice of noise") {
  const MpiExecutor executor(MPI_COMM_WORLD);
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 12, 1));
  const std::span<const WalkSequence> all(walks);
  const auto compare = [&](const auto& on) {
    return compare_models<ProportionalCorrection, SimpleLinearCorrection>(all, {.folds = 5}, on, 1);
  };
  const auto serial = compare(Serial{}), together = compare(executor);
  REQUIRE(together.size() == serial.size());
  for (std::size_t i = 0; i < serial.size(); ++i) {
    CHECK(together[i].position == serial[i].position);
    CHECK(together[i].heading == serial[i].heading);
    CHECK(together[i].chosen == serial[i].chosen);
  }
  LearningCurveOptions options{.counts = {2, 4}, .repetitions = 5};
  options.predictor.method = FitMethod::published;
  const auto curve = learning_curve<ProportionalCorrection>(all, options, Serial{}, 1);
  const auto curve_together = learning_curve<ProportionalCorrection>(all, options, executor, 1);
  CHECK((curve_together.position == curve.position).all());
  CHECK(curve_together.coefficients == curve.coefficients);
  const auto noise = choose_noise(toys::paper_walk(), all, {.folds = 3}, Serial{});
  const auto noise_together = choose_noise(toys::paper_walk(), all, {.folds = 3}, executor);
  CHECK(noise_together.chosen == noise.chosen);
  for (std::size_t i = 0; i < noise.candidates.size(); ++i) {
    CHECK(noise_together.candidates[i].heldout == noise.candidates[i].heldout);
    CHECK(noise_together.candidates[i].noise.per_speed == noise.candidates[i].noise.per_speed);
  }
}

}  // namespace
}  // namespace surefoot

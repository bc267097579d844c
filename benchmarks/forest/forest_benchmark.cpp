// Forests on the data of data.hpp: training, prediction, files.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "benchmarks/forest/data.hpp"
#include "benchmarks/forest/forests.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/serialize.hpp"

namespace {

using namespace surefoot;
using namespace surefoot::bench;

template <int Outputs>
constexpr std::integral_constant<int, Outputs> outputs{};

// Training on range(0) samples, with the share of a test set's variance that the forest explains.
template <LeafModel Leaf, int Outputs, Executor E>
void train(benchmark::State& state, Leaf, std::integral_constant<int, Outputs>, const ExtraTreesOptions& options,
           const E& executor) {
  const auto samples = make_samples<Outputs>(state.range(0), 1);
  Forest<6, Outputs, Leaf> forest;
  for (auto _ : state) forest = train_extra_trees<Leaf>(samples, options, executor, 1);
  state.counters["leaves"] = static_cast<double>(forest.leaves() / forest.trees());
  state.counters["R2"] = explained(forest, make_samples<Outputs>(20'000, 2));
}

const ExtraTreesOptions fully_grown = {.min_leaf = 2};
const ExtraTreesOptions by_fit = {.min_leaf = 20};
const ExtraTreesOptions by_variance = {.min_leaf = 20, .model_score = false};

void sample_counts(benchmark::internal::Benchmark* b) {
  b->Arg(5'000)->Arg(50'000)->Arg(250'000)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK_CAPTURE(train, constant, ConstantLeaf{}, outputs<1>, fully_grown, Serial{})->Apply(sample_counts);
BENCHMARK_CAPTURE(train, constant_threads, ConstantLeaf{}, outputs<1>, fully_grown, Threads{})->Apply(sample_counts);
BENCHMARK_CAPTURE(train, constant_3_outputs, ConstantLeaf{}, outputs<3>, fully_grown, Serial{})->Apply(sample_counts);
BENCHMARK_CAPTURE(train, linear, LinearLeaf{}, outputs<1>, by_fit, Serial{})->Apply(sample_counts);
BENCHMARK_CAPTURE(train, linear_by_variance, LinearLeaf{}, outputs<1>, by_variance, Serial{})->Apply(sample_counts);
BENCHMARK_CAPTURE(train, linear_3_outputs, LinearLeaf{}, outputs<3>, by_fit, Serial{})->Apply(sample_counts);

constexpr std::size_t queries = 4096;

// Points to predict for, `group` at a time within 5 % of a random state; 1: all anywhere.
std::vector<float> make_queries(std::size_t group) {
  Rng rng(3);
  Vec<6> center;
  std::vector<float> points;
  for (std::size_t i = 0; i < queries; ++i) {
    if (i % group == 0) center = random_state(rng);
    const Vec<6> s = group == 1 ? center : Vec<6>(0.95 * center + 0.05 * random_state(rng));
    for (const double x : s) points.push_back(static_cast<float>(x));
  }
  return points;
}

void per_prediction(benchmark::State& state, std::size_t per_iteration) {
  state.counters["s/prediction"] = benchmark::Counter(
      static_cast<double>(per_iteration), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// One point at a time, anywhere.
template <LeafModel Leaf, int Outputs>
void predict_single(benchmark::State& state, Leaf, std::integral_constant<int, Outputs>) {
  const auto& forest = forest_of<Leaf, Outputs>(state.range(0));
  std::vector<Vec<6>> points;
  Rng rng(3);
  for (std::size_t i = 0; i < queries; ++i) points.push_back(random_state(rng));
  for (auto _ : state) {
    for (const Vec<6>& x : points) benchmark::DoNotOptimize(forest.predict(x));
  }
  per_prediction(state, queries);
}

// 200 points at a time, neighbours or anywhere.
template <LeafModel Leaf, int Outputs>
void predict_batch(benchmark::State& state, Leaf, std::integral_constant<int, Outputs>, bool neighbours) {
  constexpr std::size_t batch = 200;
  const auto& forest = forest_of<Leaf, Outputs>(state.range(0));
  const std::vector<float> points = make_queries(neighbours ? batch : 1);
  std::vector<double> out(batch * Outputs);
  for (auto _ : state) {
    for (std::size_t i = 0; i + batch <= queries; i += batch) {
      forest.predict(&points[6 * i], batch, out.data());
      benchmark::DoNotOptimize(out.data());
    }
  }
  per_prediction(state, queries / batch * batch);
}

void leaf_counts(benchmark::internal::Benchmark* b) { b->Arg(200)->Arg(2'000)->Arg(20'000); }
BENCHMARK_CAPTURE(predict_single, constant, ConstantLeaf{}, outputs<1>)->Apply(leaf_counts);
BENCHMARK_CAPTURE(predict_single, constant_3_outputs, ConstantLeaf{}, outputs<3>)->Apply(leaf_counts);
BENCHMARK_CAPTURE(predict_single, linear, LinearLeaf{}, outputs<1>)->Apply(leaf_counts);
BENCHMARK_CAPTURE(predict_single, linear_3_outputs, LinearLeaf{}, outputs<3>)->Apply(leaf_counts);
BENCHMARK_CAPTURE(predict_batch, constant_anywhere, ConstantLeaf{}, outputs<1>, false)->Apply(leaf_counts);
BENCHMARK_CAPTURE(predict_batch, constant_neighbours, ConstantLeaf{}, outputs<1>, true)->Apply(leaf_counts);
BENCHMARK_CAPTURE(predict_batch, linear_neighbours, LinearLeaf{}, outputs<1>, true)->Apply(leaf_counts);
BENCHMARK_CAPTURE(predict_batch, linear_3_outputs_neighbours, LinearLeaf{}, outputs<3>, true)->Apply(leaf_counts);

void save_forest(benchmark::State& state) {
  const auto& forest = forest_of<ConstantLeaf, 1>(state.range(0));
  for (auto _ : state) {
    ByteWriter out;
    write(out, forest);
    benchmark::DoNotOptimize(out.bytes().data());
  }
}
void load_forest(benchmark::State& state) {
  ByteWriter out;
  write(out, forest_of<ConstantLeaf, 1>(state.range(0)));
  for (auto _ : state) {
    ByteReader in(out.bytes(), "memory");
    benchmark::DoNotOptimize(read<Forest<6, 1>>(in));
  }
}
BENCHMARK(save_forest)->Arg(20'000)->Unit(benchmark::kMillisecond);
BENCHMARK(load_forest)->Arg(20'000)->Unit(benchmark::kMillisecond);

}  // namespace

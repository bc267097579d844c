// Forests on data of the shape the solver has: six inputs like the states of a ball approach, a value-like target with
// cliffs, and a policy-like target with three clipped outputs.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <type_traits>
#include <utility>
#include <vector>

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

Vec<6> random_state(Rng& rng) {
  constexpr double pi = std::numbers::pi;
  Vec<6> s;
  s << rng.uniform(0, 1), rng.uniform(-pi, pi), rng.uniform(-pi, pi), rng.uniform(-0.02, 0.04),
      rng.uniform(-0.02, 0.02), rng.uniform(-0.2, 0.2);
  return s;
}

template <int Outputs>
Vec<Outputs> target(const Vec<6>& s) {
  const double x = s[0] * std::cos(s[1]);
  const double y = s[0] * std::sin(s[1]);
  Vec<Outputs> out;
  if constexpr (Outputs == 1) {
    out[0] = -5 * std::abs(x - 0.22) - 4 * std::abs(y) - 3 * std::abs(s[2]) - 1.5 * std::abs(s[1]);
    if (x > -0.2 && x < 0.15 && std::abs(y) < 0.25) out[0] -= 3;
    if (s[0] > 0.95) out[0] -= 30;
  } else {
    const bool near = std::abs(s[2]) < 0.3 && s[0] < 0.5;
    const double vx = near ? 0.2 * (x - 0.22) : std::max(0.0, 0.04 * std::cos(s[1]));
    const double vy = near ? 0.18 * y : -0.05 * s[2];
    const double vt = near ? 0.2 * s[2] : 0.4 * s[1];
    out << (vx - s[3]) / 0.02, (vy - s[4]) / 0.01, (vt - s[5]) / 0.15;
    out = out.cwiseMax(-1).cwiseMin(1);
  }
  return out;
}

template <int Outputs>
Dataset<6, Outputs> make_samples(Eigen::Index count, std::uint64_t seed) {
  Dataset<6, Outputs> samples;
  samples.inputs.resize(6, count);
  samples.outputs.resize(Outputs, count);
  Rng rng(seed);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec<6> s = random_state(rng);
    samples.inputs.col(i) = s.cast<float>();
    samples.outputs.col(i) = target<Outputs>(s);
  }
  return samples;
}

template <class F, int Outputs>
double explained(const F& forest, const Dataset<6, Outputs>& test) {
  Eigen::Matrix<double, Outputs, Eigen::Dynamic> predicted;
  forest.predict(test.inputs, predicted);
  const Vec<Outputs> mean = test.outputs.rowwise().mean();
  return 1 - (predicted - test.outputs).squaredNorm() / (test.outputs.colwise() - mean).squaredNorm();
}

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

// A forest of 25 trees with so many leaves each; trained once.
template <LeafModel Leaf, int Outputs>
const Forest<6, Outputs, Leaf>& forest_of(std::int64_t leaves) {
  static std::map<std::int64_t, Forest<6, Outputs, Leaf>> forests;
  auto [at, fresh] = forests.try_emplace(leaves);
  if (fresh) {
    at->second = train_extra_trees<Leaf>(make_samples<Outputs>(10'000 + 7 * leaves, 1),
                                         {.min_leaf = 2, .max_leaves = static_cast<int>(leaves), .model_score = false},
                                         Threads{}, 1);
  }
  return at->second;
}

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

#include <benchmark/benchmark.h>

#include <random>

#include "surefoot/core/rng.hpp"

namespace {

void uniform(benchmark::State& state) {
  surefoot::Rng rng(1);
  for (auto _ : state) benchmark::DoNotOptimize(rng.uniform());
}
BENCHMARK(uniform);

void normal(benchmark::State& state) {
  surefoot::Rng rng(1);
  for (auto _ : state) benchmark::DoNotOptimize(rng.normal());
}
BENCHMARK(normal);

// A transition's noise in full: its stream is named, then three numbers are drawn.
void stream_and_three_uniform(benchmark::State& state) {
  const surefoot::Rng run(1);
  std::uint64_t transition = 0;
  for (auto _ : state) {
    surefoot::Rng noise = run.stream(transition++);
    benchmark::DoNotOptimize(noise.uniform() + noise.uniform() + noise.uniform());
  }
}
BENCHMARK(stream_and_three_uniform);

// The peer: the standard library's generator, which has no streams.
void peer_mersenne_twister_uniform(benchmark::State& state) {
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (auto _ : state) benchmark::DoNotOptimize(uniform(rng));
}
BENCHMARK(peer_mersenne_twister_uniform);

void peer_mersenne_twister_seed_and_three_uniform(benchmark::State& state) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::uint64_t transition = 0;
  for (auto _ : state) {
    std::mt19937_64 noise(transition++);
    benchmark::DoNotOptimize(uniform(noise) + uniform(noise) + uniform(noise));
  }
}
BENCHMARK(peer_mersenne_twister_seed_and_three_uniform);

}  // namespace

// Our forests alone: how time grows with trees, leaves, samples, outputs and threads, one at a time.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "measure.hpp"
#include "samples.hpp"
#include "surefoot.hpp"

namespace {

using namespace peers;

struct Case {
  std::size_t samples = 50'000;
  std::size_t outputs = 1;
  Size size = {.trees = 25, .leaves = 2'000, .min_leaf = 4, .threads = 1};
};

/// One line: what varies, its value, which leaves, training [s], per prediction warm, cold, batch [ns].
void run(const char* axis, std::size_t value, const Case& variant, const char* leaf, Train train, std::size_t rounds) {
  const Samples samples = make_samples(variant.outputs, variant.samples, 1);
  const std::vector<float> points = make_samples(1, 4096, 3).x;
  Evictor evict;
  std::vector<double> training;
  std::vector<Latency> latency;
  for (std::size_t round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    const auto model = train(samples, variant.size);
    training.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    latency.push_back(measure(*model, points, evict, 50, round));
  }
  const Latency time = median(latency);
  std::printf("%s;%zu;%s;%g;%g;%g;%g\n", axis, value, leaf, median(training), time.warm, time.cold, time.batch);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t rounds = 3;
  CLI::App app("How our forests' times scale, as CSV");
  app.add_option("--rounds", rounds)->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  std::printf("axis;value;leaf;training [s];warm [ns];cold [ns];batch [ns]\n");
  const auto vary = [&](const char* axis, const std::vector<std::size_t>& values, auto&& set) {
    for (const std::size_t value : values) {
      Case variant;
      set(variant, value);
      run(axis, value, variant, "constant", train_constant, rounds);
      run(axis, value, variant, "linear", train_linear, rounds);
    }
  };
  vary("trees", {1, 5, 25, 100}, [](Case& c, std::size_t value) { c.size.trees = static_cast<int>(value); });
  vary("leaves", {20, 200, 2'000, 10'000}, [](Case& c, std::size_t value) { c.size.leaves = static_cast<int>(value); });
  vary("samples", {5'000, 20'000, 80'000, 320'000}, [](Case& c, std::size_t value) { c.samples = value; });
  vary("outputs", {1, 3, 6}, [](Case& c, std::size_t value) { c.outputs = value; });
  std::vector<std::size_t> threads;
  for (std::size_t count = 1; count <= std::thread::hardware_concurrency(); count *= 2) threads.push_back(count);
  vary("threads", threads, [](Case& c, std::size_t value) { c.size.threads = value; });
}

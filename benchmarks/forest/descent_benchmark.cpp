// Single predictions, as a Forest makes them, against the way down that was the only one before: eight trees in a
// vector, nodes in small pages.
// Both take turns, so that a busy machine slows both; the ratio is the median over the turns.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <span>
#include <vector>

#include "benchmarks/forest/data.hpp"
#include "benchmarks/forest/forests.hpp"
#include "surefoot/forest/forest.hpp"

namespace {

using namespace surefoot;
using namespace surefoot::bench;
using Keys = std::array<std::uint64_t, 7>;
using Payloads = std::array<std::uint32_t, 25>;

/// CPU time of this thread for many calls, which other programs do not lengthen; the clock for a single one, which is
/// much cheaper to read.
double nanoseconds(bool cpu_time) {
  timespec now{};
  clock_gettime(cpu_time ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<Keys> random_keys(std::size_t count) {
  Rng rng(3);
  std::vector<Keys> all(count);
  for (Keys& keys : all) {
    const Vec<6> state = random_state(rng);
    for (std::size_t k = 0; k < 6; ++k) keys[k] = wide_key(static_cast<float>(state[static_cast<int>(k)]));
    keys[6] = 0;
  }
  return all;
}

/// A copy of the nodes in pages as small as they come.
class SmallPages {
 public:
  explicit SmallPages(std::span<const Node> nodes)
      : memory_(static_cast<Node*>(std::aligned_alloc(detail::cache_line, nodes.size_bytes())), &std::free) {
    std::memcpy(memory_.get(), nodes.data(), nodes.size_bytes());
  }
  const Node* nodes() const { return memory_.get(); }

 private:
  std::unique_ptr<Node, void (*)(void*)> memory_;
};

/// Where only the first node is said to be there, the vector's way is taken.
[[gnu::noinline]] void descend_before(const SmallPages& pages, const Trees& trees, const Keys& keys,
                                      Payloads& payloads) {
  detail::find_leaves(std::span(pages.nodes(), 1), trees.roots, keys, payloads.data());
}

[[gnu::noinline]] void descend_now(const Trees& trees, const detail::Blocks& blocks, const Keys& keys,
                                   Payloads& payloads) {
  if (blocks.roots.empty()) {
    detail::find_leaves(trees.nodes, trees.roots, keys, payloads.data());
  } else {
    detail::find_leaves_in_blocks(blocks.blocks, blocks.roots, keys, payloads.data());
  }
}

/// Writes to twice as many bytes as the last cache has, so that nothing else is in any cache, addresses included.
class Evictor {
 public:
  void operator()() {
    volatile unsigned char* bytes = buffer_.data();
    for (std::size_t i = 0; i < buffer_.size(); i += detail::cache_line) {
      bytes[i] = static_cast<unsigned char>(bytes[i] + 1);
    }
  }

 private:
  static std::size_t last_cache() {
    const long bytes = sysconf(_SC_LEVEL3_CACHE_SIZE);
    return bytes > 0 ? static_cast<std::size_t>(bytes) : std::size_t{32} << 20U;
  }
  std::vector<unsigned char> buffer_ = std::vector<unsigned char>(2 * last_cache());
};

/// `cold`: one prediction at a time, nothing in the caches; else all points, which visit most nodes several times, for
/// the second time in a row.
void descent(benchmark::State& state, bool cold) {
  const Trees& trees = forest_of<ConstantLeaf, 1>(state.range(0)).raw();
  const SmallPages pages(trees.nodes);
  const detail::Blocks blocks = detail::blocks_pay(trees) ? detail::make_blocks(trees) : detail::Blocks{};
  const std::vector<Keys> points = random_keys(4096);
  const std::size_t group = cold ? 1 : points.size();
  Evictor evict;
  std::vector<double> times_before, times_now, ratios;
  Payloads payloads{}, expected{};
  std::size_t first = 0;
  const auto time = [&](const auto& descend) {
    const auto predict = [&] {
      for (std::size_t i = first; i < first + group; ++i) descend(points[i]);
    };
    if (cold) {
      evict();
    } else {
      predict();
    }
    const double start = nanoseconds(!cold);
    predict();
    return (nanoseconds(!cold) - start) / static_cast<double>(group);
  };
  const auto before = [&](const Keys& keys) { descend_before(pages, trees, keys, expected); };
  const auto now = [&](const Keys& keys) { descend_now(trees, blocks, keys, payloads); };
  bool now_first = false;
  for (auto _ : state) {
    now_first = !now_first;
    if (now_first) times_now.push_back(time(now));
    times_before.push_back(time(before));
    if (!now_first) times_now.push_back(time(now));
    if (payloads != expected) state.SkipWithError("the two ways end in different leaves");
    ratios.push_back(times_before.back() / times_now.back());
    first = (first + group) % points.size();
  }
  state.counters["ns_before"] = median(times_before);
  state.counters["ns_now"] = median(times_now);
  state.counters["ratio"] = median(ratios);
}

void sizes(benchmark::internal::Benchmark* b) { b->Arg(200)->Arg(2'000)->Arg(20'000)->Iterations(101); }
BENCHMARK_CAPTURE(descent, warm, false)->Apply(sizes);
BENCHMARK_CAPTURE(descent, cold, true)->Apply(sizes);

}  // namespace

// Prediction must not allocate: operator new is replaced by one that counts.
#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <span>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "tests/forest/samples.hpp"

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace surefoot {
namespace {

TEST_CASE_TEMPLATE("predicting allocates nothing", Leaf, ConstantLeaf, LinearLeaf) {
  const auto samples = toy::sample(toy::ClippedLaws{}, 300, 1);
  long before = allocations;
  const auto forest = train_extra_trees<Leaf>(samples, {}, Serial{}, 1);
  CHECK(allocations > before);  // the counter works
  const Vec<4> x = samples.inputs.col(0).cast<double>();
  typename Forest<4, 2, Leaf>::BatchOutput out(2, 300);
  before = allocations;
  const Vec<2> y = forest.predict(x);
  forest.predict(samples.inputs, out);
  forest.predict(samples.inputs.data(), 300, out.data());
  const Spread<2> spread = forest.predict_spread(x);
  std::array<std::uint32_t, 25> leaves;
  forest.leaf_indices(x, std::span(leaves).first(forest.trees()));
  CHECK(allocations == before);
  CHECK(spread.mean == y);
  CHECK(out.col(0) == y);
}

}  // namespace
}  // namespace surefoot

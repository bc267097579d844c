// Decision trees in memory: 8-byte nodes in one flat array, made for branch-free descent.
//
// A node is (key, link). An inner node's key is its threshold as an integer that sorts like the float, its link the
// input it tests (low 8 bits) and how many nodes further its children are (high 24 bits): the left child (x <=
// threshold, or NaN), and next to it the right one. A leaf links to itself: distance 0, and its input is the slot
// behind the last, whose key is 0 and so never greater. Hence one step is, for leaves too,
//
//   node += (link >> 8) + (input_key[link & 255] > key)
//
// and a leaf's key is free for its payload: the bits of its only parameter, or the number of its parameters' row.
// Distances are relative, so trees can be moved and joined freely. A tree starts at a multiple of 8 nodes (one cache
// line) with its root and an unused sibling.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"

namespace surefoot {

constexpr int max_forest_inputs = 255;

/// An unsigned integer that sorts like the float; -0 counts as 0. NaN gives 0 (below everything).
constexpr std::uint32_t sort_key(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value + 0.0F);
  const std::uint32_t all_if_negative = 0U - (bits >> 31);  // without a branch: signs are as good as random
  return value != value ? 0 : bits ^ (all_if_negative | 0x80000000U);
}

/// The sort key as Node::step wants it.
constexpr std::uint64_t wide_key(float value) { return std::uint64_t{sort_key(value)} << 32; }

/// The float that a sort key came from.
constexpr float from_sort_key(std::uint32_t key) {
  return std::bit_cast<float>((key >> 31) != 0 ? key & 0x7FFFFFFFU : ~key);
}

class Node {
 public:
  static constexpr std::uint32_t max_distance = (1U << 24) - 2;

  constexpr Node() = default;
  constexpr Node(std::uint32_t key, std::uint32_t link) : bits_((std::uint64_t{key} << 32) | link) {}
  static constexpr Node inner(int input, float threshold, std::uint32_t distance) {
    return {sort_key(threshold), (distance << 8) | static_cast<std::uint32_t>(input)};
  }
  static constexpr Node leaf(int inputs, std::uint32_t payload) {
    return {payload, static_cast<std::uint32_t>(inputs)};
  }

  constexpr std::uint32_t key() const { return static_cast<std::uint32_t>(bits_ >> 32); }
  constexpr std::uint32_t link() const { return static_cast<std::uint32_t>(bits_); }
  constexpr std::uint32_t distance() const { return link() >> 8; }
  constexpr int input() const { return static_cast<int>(link() & 255U); }
  constexpr bool is_leaf() const { return distance() == 0; }
  constexpr float threshold() const { return from_sort_key(key()); }  // of an inner node
  constexpr std::uint32_t payload() const { return key(); }           // of a leaf

  /// How far to go from here; `wide_keys` are the inputs' (see wide_key) and, behind the last, a 0. Comparing all 64
  /// bits at once compares the keys: on equal keys the link decides, which is never below 0.
  constexpr std::size_t step(const std::uint64_t* wide_keys) const {
    return static_cast<std::size_t>(distance()) + (bits_ < wide_keys[bits_ & 255U] ? 1U : 0U);
  }

  constexpr bool operator==(const Node&) const = default;

 private:
  std::uint64_t bits_;
};
static_assert(sizeof(Node) == 8);

namespace detail {

constexpr std::size_t cache_line = 64;
constexpr std::size_t large_page = std::size_t{2} << 20U;

/// Memory from the start of a cache line, or, from two large pages on, of such pages, where the system has them to
/// give: a descent then does not wait for the addresses of the many small ones that it jumps between.
void* allocate_lines(std::size_t bytes);
void release_lines(void* memory, std::size_t bytes);

}  // namespace detail

/// Allocates whole cache lines, and leaves new items as they are unless a value is given.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  explicit CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(detail::allocate_lines(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t count) { detail::release_lines(memory, count * sizeof(T)); }
  template <class U>
  void construct(U* item) {
    ::new (static_cast<void*>(item)) U;
  }
  template <class U, class... Values>
  void construct(U* item, Values&&... values) {
    ::new (static_cast<void*>(item)) U(std::forward<Values>(values)...);
  }
  template <class U>
  bool operator==(const CacheLineAllocator<U>&) const {
    return true;
  }
};

using NodeArray = std::vector<Node, CacheLineAllocator<Node>>;
constexpr std::size_t nodes_per_line = detail::cache_line / sizeof(Node);

/// Sizes of the trees of a forest.
struct TreesShape {
  int inputs = 0;
  int outputs = 0;
  std::size_t leaf_parameters = 0;  // floats per leaf; 1: kept in the leaf's node, `parameters` is empty
  std::size_t leaves = 0;           // of all trees together

  bool inline_leaves() const { return leaf_parameters == 1; }

  std::string shape() const;  // for messages

  bool operator==(const TreesShape&) const = default;
};

/// The trees of a forest, sizes known at run time only; Forest is the typed shell around it.
struct Trees : TreesShape {
  NodeArray nodes;
  std::vector<std::uint32_t> roots;  // index of each tree's root in `nodes`
  std::vector<float> parameters;     // leaf_parameters per leaf
  static constexpr auto fields = std::tuple(&TreesShape::inputs, &TreesShape::outputs, &TreesShape::leaf_parameters,
                                            &TreesShape::leaves, &Trees::nodes, &Trees::roots, &Trees::parameters);

  /// Adds the trees of another forest of the same shape behind these.
  void append(const Trees& other);

  bool operator==(const Trees&) const = default;
};

/// Trees that lie elsewhere, as in a mapped file; that memory must outlive this.
struct TreesView : TreesShape {
  std::span<const Node> nodes;
  std::span<const std::uint32_t> roots;
  std::span<const float> parameters;
};

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/trees.ipp"
#endif

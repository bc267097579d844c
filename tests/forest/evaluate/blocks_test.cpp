#include "surefoot/forest/evaluate/blocks.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot::detail {
namespace {

using Query = std::array<float, 5>;

/// Where a path ends, and how many lines it goes through.
struct End {
  std::uint32_t payload = 0;
  int lines = 1;
};

End end_in_blocks(const Blocks& blocks, std::size_t tree, const Query& x) {
  End end;
  for (PartReference part = blocks.roots[tree];; ++end.lines) {
    const Block& block = blocks.blocks.at((part & block_offset) / sizeof(Block));
    unsigned right = 0;
    for (std::size_t i = 0; i < nodes_per_block; ++i) {
      const std::uint32_t key = sort_key(x.at(block.inputs >> (4 * i) & 15U)) ^ 0x80000000U;
      right |= (static_cast<std::int32_t>(key) > block.keys[i] ? 1U : 0U) << i;
    }
    std::size_t exit = part / 8 % 8;
    while ((block.passed[exit] & right) != 0) ++exit;
    end.payload = block.exits.at(exit);
    if ((part & last_part) != 0) return end;
    part = end.payload;
  }
}

End end_in_nodes(const Trees& trees, std::size_t tree, const Query& x) {
  End end;
  for (std::size_t at = trees.roots[tree];;) {
    const Node node = trees.nodes[at];
    if (node.is_leaf()) {
      end.payload = node.payload();
      return end;
    }
    const std::size_t next = at + node.distance() + (x.at(static_cast<std::size_t>(node.input())) > node.threshold());
    end.lines += next / nodes_per_line != at / nodes_per_line ? 1 : 0;
    at = next;
  }
}

std::vector<Query> queries(std::size_t count) {
  Rng rng(2);
  std::vector<Query> all(count);
  for (Query& x : all) {
    for (float& value : x) value = static_cast<float>(rng.uniform(-1.2, 1.2));
  }
  return all;
}

Trees grown(int samples, int min_leaf) {
  return train_extra_trees(toy::sample(toy::Cliff{}, samples, 1), {.trees = 10, .min_leaf = min_leaf}, Serial{}, 1)
      .raw();
}

TEST_CASE("a tree in blocks has the leaves of its nodes where they were") {
  for (const int samples : {1, 2, 4, 7, 8, 9, 16, 50, 3000}) {
    CAPTURE(samples);
    const Trees trees = grown(samples, 1);
    const Blocks blocks = make_blocks(trees);
    REQUIRE(blocks.roots.size() == trees.roots.size());
    int differences = 0;
    for (const Query& x : queries(300)) {
      for (std::size_t t = 0; t < 10; ++t) {
        differences += end_in_blocks(blocks, t, x).payload != end_in_nodes(trees, t, x).payload ? 1 : 0;
      }
    }
    CHECK(differences == 0);
  }
}

TEST_CASE("blocks take three quarters of the bytes, and a path fewer lines") {
  const Trees trees = grown(6000, 2);
  const Blocks blocks = make_blocks(trees);
  const double share = static_cast<double>(blocks.blocks.size() * sizeof(Block)) /
                       static_cast<double>(trees.nodes.size() * sizeof(Node));
  CHECK(share < 0.8);
  int in_blocks = 0, in_nodes = 0;
  for (const Query& x : queries(300)) {
    for (std::size_t t = 0; t < 10; ++t) {
      in_blocks += end_in_blocks(blocks, t, x).lines;
      in_nodes += end_in_nodes(trees, t, x).lines;
    }
  }
  CHECK(in_blocks < 0.9 * in_nodes);
}

TEST_CASE("blocks are full: parts of a tree share them") {
  const Blocks blocks = make_blocks(grown(6000, 2));
  std::size_t used = 0;
  for (const Block& block : blocks.blocks) {
    for (const std::int32_t key : block.keys) used += key != Block::never ? 1 : 0;
  }
  // A block of k parts has 7 - k thresholds; most have one or two parts.
  CHECK(static_cast<double>(used) > 0.8 * static_cast<double>(blocks.blocks.size() * nodes_per_block));
}

}  // namespace
}  // namespace surefoot::detail

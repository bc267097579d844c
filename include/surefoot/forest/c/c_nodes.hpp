// The nodes of a forest in a C file, for a descent like the library's: a step is the same for leaves, which stay where
// they are, so that four trees go down side by side without a jump that a processor could guess wrong.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

/// Tables over the nodes in the library's order, which keeps together what is read together; siblings are neighbours,
/// the left one first.
struct CNodes {
  int input_bits;                    // lowest bits of a word
  std::vector<std::uint32_t> roots;  // of each tree
  std::vector<std::uint32_t> words;  // how far on the left child is (of a leaf its number) << input_bits | the input;
                                     // that of a leaf is one behind the last
  std::vector<float> thresholds;     // of a leaf 0
  std::vector<std::uint32_t> payloads;  // of each leaf, as Node has them

  explicit CNodes(const Trees& from) : input_bits(std::bit_width(static_cast<unsigned>(from.inputs))) {
    std::vector<char> used(from.nodes.size(), 0);  // cache lines are filled up with nodes of no tree
    for (const std::uint32_t root : from.roots) used[root] = 1;
    std::vector<std::uint32_t> place(from.nodes.size(), 0);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < from.nodes.size(); ++i) {  // children lie behind their parents
      if (used[i] == 0) continue;
      place[i] = count++;
      const Node node = from.nodes[i];
      if (!node.is_leaf()) used[i + node.distance()] = used[i + node.distance() + 1] = 1;
    }
    for (std::size_t i = 0; i < from.nodes.size(); ++i) {
      if (used[i] == 0) continue;
      const Node node = from.nodes[i];
      const auto high =
          static_cast<std::uint32_t>(node.is_leaf() ? payloads.size() : place[i + node.distance()] - place[i]);
      words.push_back(high << input_bits | static_cast<std::uint32_t>(node.input()));
      thresholds.push_back(node.is_leaf() ? 0.0F : node.threshold());
      if (node.is_leaf()) payloads.push_back(node.payload());
    }
    for (const std::uint32_t root : from.roots) roots.push_back(place[root]);
  }

  std::uint32_t input(std::size_t node) const { return words[node] & input_mask(); }
  std::uint32_t input_mask() const { return (1U << input_bits) - 1; }

  /// The smallest C type of the words.
  std::string word_type() const {
    const std::uint32_t widest = words.empty() ? 0 : *std::ranges::max_element(words);
    return widest < 0x100U ? "uint8_t" : widest < 0x10000U ? "uint16_t" : "uint32_t";
  }

  /// `void NAME_leaves(const TYPE *x, uint32_t tree, uint32_t count, uint32_t *at)`: the nodes where x ends in four
  /// trees from `tree` on, of which there are `count`. x has a slot more than there are inputs. `threshold`: that of
  /// node n, in C.
  std::string descent(const std::string& name, const std::string& type, int inputs,
                      const std::string& threshold) const {
    const std::string word = name + "_nodes[n]", input = word + " & " + std::to_string(input_mask());
    return "#define step(n) (((uint32_t)(" + word + " >> " + std::to_string(input_bits) + ") + (uint32_t)(x[" + input +
           "] > " + threshold + ")) & \\\n    (0u - (uint32_t)((" + input + ") != " + std::to_string(inputs) +
           ")))\nstatic void " + name + "_leaves(const " + type +
           " *x, uint32_t tree, uint32_t count, uint32_t *at) {\n" + "  const uint32_t *root = " + name +
           R"(_roots + tree;
  uint32_t a = root[0], b = root[count > 1 ? 1 : 0], c = root[count > 2 ? 2 : 0], d = root[count > 3 ? 3 : 0], i, j, k, l;
  do {
    i = step(a);
    j = step(b);
    k = step(c);
    l = step(d);
    a += i;
    b += j;
    c += k;
    d += l;
  } while ((i | j | k | l) != 0);
  at[0] = a;
  at[1] = b;
  at[2] = c;
  at[3] = d;
}
#undef step

)";
  }
};

}  // namespace surefoot::detail

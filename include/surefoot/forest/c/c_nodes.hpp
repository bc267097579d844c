// The nodes of a forest in a C file, for a descent like the library's: a step is the same for leaves, which stay where
// they are, so that several trees go down side by side without a jump that a processor could guess wrong.
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
  int input_bits;                       // lowest bits of a word
  bool words_name_leaves;               // else a leaf's word says 0, and goes nowhere by itself
  std::vector<std::uint32_t> roots;     // of each tree
  std::vector<std::uint32_t> words;     // how far on the left child is (of a leaf its number, or 0) << input_bits | the
                                        // input; that of a leaf is one behind the last
  std::vector<float> thresholds;        // of a leaf 0
  std::vector<std::uint32_t> payloads;  // of each leaf, as Node has them

  CNodes(const Trees& from, bool words_name_the_leaves)
      : input_bits(static_cast<int>(std::bit_width(static_cast<unsigned>(from.inputs)))),
        words_name_leaves(words_name_the_leaves) {
    std::vector<std::uint8_t> used(from.nodes.size(), 0);  // cache lines are filled up with nodes of no tree
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
      const auto leaf = static_cast<std::uint32_t>(words_name_leaves ? payloads.size() : 0);
      const std::uint32_t high = node.is_leaf() ? leaf : place[i + node.distance()] - place[i];
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

  /// Trees side by side: at most eight, and groups of about the same size.
  std::size_t lanes() const {
    constexpr std::size_t most = 8;
    const std::size_t groups = (roots.size() + most - 1) / most;
    return (roots.size() + groups - 1) / groups;
  }

  /// `void NAME_leaves(const TYPE *x, uint32_t tree, uint32_t count, uint32_t *at)`: the nodes where x ends in lanes()
  /// trees from `tree` on, of which there are `count`. x has a slot more than there are inputs, with the least number.
  /// `threshold`: that of node n, in C.
  std::string descent(const std::string& name, const std::string& type, int inputs,
                      const std::string& threshold) const {
    const std::string word = name + "_nodes[n]", input = word + " & " + std::to_string(input_mask());
    std::string step = "((uint32_t)(" + word + " >> " + std::to_string(input_bits) + ") + (uint32_t)(x[" + input +
                       "] > " + threshold + "))";
    if (words_name_leaves)
      step = "(" + step + " & \\\n    (0u - (uint32_t)((" + input + ") != " + std::to_string(inputs) + ")))";
    std::string names = "  uint32_t ", moves, adds, moved, ends;
    for (std::size_t lane = 0; lane < lanes(); ++lane) {
      const std::string l = std::to_string(lane), comma = lane == 0 ? "" : ", ";
      names += comma + "n" + l + " = root[" + (lane == 0 ? "0" : "count > " + l + " ? " + l + " : 0") + "], s" + l;
      moves += "    s" + l + " = step(n" + l + ");\n";
      adds += "    n" + l + " += s" + l + ";\n";
      moved += (lane == 0 ? "" : " | ") + ("s" + l);
      ends += "  at[" + l + "] = n" + l + ";\n";
    }
    return "#define step(n) " + step + "\nstatic void " + name + "_leaves(const " + type +
           " *x, uint32_t tree, uint32_t count, uint32_t *at) {\n  const uint32_t *root = " + name +
           "_roots + tree;\n" + names + ";\n" + (lanes() == 1 ? "  (void)count;\n" : "") + "  do {\n" + moves + adds +
           "  } while ((" + moved + ") != 0);\n" + ends + "}\n#undef step\n\n";
  }
};

}  // namespace surefoot::detail

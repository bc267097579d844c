// A forest as one C99 file without dependencies, for a micro-controller: tables of 32-bit numbers and a few lines of
// code that give the same outputs as Forest::predict.
//
// Per inner node the file has one small integer and one threshold, per leaf its numbers: about 14 characters for each
// inner node and 10 (or 5, see CTable) for each of a leaf's numbers; in the machine 2 or 4 + 4 bytes, and 4 (5) bytes.
#pragma once

#include <algorithm>
#include <bit>
#include <cctype>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot {

/// How a C file spells its tables of numbers.
enum class CTable {
  integers,  // hexadecimal integers of 64 bits: no decoding, fastest
  text,      // five characters per number in string literals: half the source, decoded at every use
};

struct ExportCOptions {
  std::string function = "surefoot_forest";  // void FUNCTION(const double in[inputs], double out[outputs])
  CTable table = CTable::integers;
  std::string wrapper = {};  // C code put behind the function, to call it: features before, clamping after; the
                             // function is then static
};

/// A leaf model that knows how to write itself in C.
template <class L>
concept CLeafModel = LeafModel<L> && requires {
  { L::c_code(1, 1) } -> std::same_as<std::string>;
};

namespace detail {

/// The tables of a forest in depth-first order. A descent needs only how many inner nodes lie left of a node: right of
/// it go the rest, and among the leaves of a tree the one reached is known by how many inner nodes it passed on its
/// right.
struct CTables {
  std::vector<std::uint32_t> trees;    // inner nodes of each tree
  std::vector<std::uint32_t> nodes;    // of each inner node: (inner nodes below its left child) * inputs + its input
  std::vector<std::uint32_t> numbers;  // bits of floats: the thresholds of the inner nodes, then the leaves' numbers

  explicit CTables(const Trees& from) {
    std::vector<std::uint32_t> inner(from.nodes.size(), 0);  // inner nodes from here on down
    for (std::size_t i = from.nodes.size(); i-- > 0;) {
      const Node node = from.nodes[i];
      if (!node.is_leaf()) inner[i] = 1 + inner[i + node.distance()] + inner[i + node.distance() + 1];
    }
    std::vector<std::uint32_t> leaves;
    std::vector<std::size_t> open;
    for (const std::uint32_t root : from.roots) {
      trees.push_back(inner[root]);
      open.push_back(root);
      while (!open.empty()) {
        const std::size_t i = open.back();
        open.pop_back();
        const Node node = from.nodes[i];
        if (node.is_leaf()) {
          leaves.push_back(node.payload());
          continue;
        }
        const std::size_t left = i + node.distance();
        nodes.push_back(inner[left] * static_cast<std::uint32_t>(from.inputs) +
                        static_cast<std::uint32_t>(node.input()));
        numbers.push_back(std::bit_cast<std::uint32_t>(node.threshold()));
        open.push_back(left + 1);
        open.push_back(left);
      }
    }
    for (const std::uint32_t leaf : leaves) {
      if (from.inline_leaves()) {
        numbers.push_back(leaf);
        continue;
      }
      const float* row = from.parameters.data() + leaf * from.leaf_parameters;
      for (std::size_t k = 0; k < from.leaf_parameters; ++k) numbers.push_back(std::bit_cast<std::uint32_t>(row[k]));
    }
  }
};

/// "{1,2,3}", broken into lines; C has no empty tables, so an empty one gets a 0.
template <class Integer>
std::string c_list(std::span<const Integer> items, const char* format) {
  std::string list = "{";
  std::size_t line = 0;
  for (const Integer item : items) {
    char text[32];
    const int length = std::snprintf(text, sizeof text, format, item);
    if (line + static_cast<std::size_t>(length) > 118) {
      list += '\n';
      line = 0;
    }
    list.append(text, static_cast<std::size_t>(length)) += ',';
    line += static_cast<std::size_t>(length) + 1;
  }
  if (items.empty()) list += "0,";
  list.back() = '}';
  return list;
}

/// The table of numbers and `static float number(uint32_t i)` to read it.
inline std::string c_numbers(const std::vector<std::uint32_t>& numbers, CTable table, const std::string& name) {
  const std::string head = "static float " + name +
                           "_number(uint32_t i) {\n"
                           "  union { uint32_t bits; float value; } n;\n";
  if (table == CTable::integers) {
    std::vector<unsigned long long> pairs((numbers.size() + 1) / 2, 0);
    for (std::size_t i = 0; i < numbers.size(); ++i) pairs[i / 2] |= std::uint64_t{numbers[i]} << (i % 2 * 32);
    return "static const uint64_t " + name +
           "_numbers[] = " + c_list(std::span<const unsigned long long>(pairs), "0x%llx") + ";\n\n" + head +
           "  n.bits = (uint32_t)(" + name + "_numbers[i / 2] >> (i % 2 * 32));\n  return n.value;\n}\n";
  }
  // Base 85, most significant digit first; '"', '\' and '?' are left out. C99 promises 4095 characters per literal.
  constexpr std::size_t row = 800;
  std::string rows;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i % row == 0) rows += i == 0 ? "\"" : "\",\n\"";
    std::uint32_t rest = numbers[i];
    char digits[5];
    for (std::size_t k = 5; k-- > 0; rest /= 85) {
      char digit = static_cast<char>('#' + rest % 85);
      if (digit >= '?') ++digit;
      if (digit >= '\\') ++digit;
      digits[k] = digit;
    }
    rows.append(digits, 5);
  }
  return "static const char " + name + "_numbers[][" + std::to_string(5 * row + 1) + "] = {\n" + rows + "\"};\n\n" +
         head + "  const char *text = " + name + "_numbers[i / " + std::to_string(row) + "] + i % " +
         std::to_string(row) +
         " * 5;\n  int k;\n  n.bits = 0;\n"
         "  for (k = 0; k < 5; ++k) n.bits = n.bits * 85 + (uint32_t)(text[k] - '#' - (text[k] > '?') - (text[k] > "
         "'\\\\'));\n"
         "  return n.value;\n}\n";
}

inline std::string indented(std::string_view code, const std::string& by) {
  std::string out = by;
  for (const char c : code) {
    out += c;
    if (c == '\n') out += by;
  }
  return out;
}

inline std::string export_c(const Trees& trees, std::uint32_t leaf_tag, const std::string& leaf_code,
                            const ExportCOptions& options) {
  const std::string& name = options.function;
  auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), letter) ||
      std::isdigit(static_cast<unsigned char>(name[0]))) {
    throw ForestError("ExportCOptions: function must be a name in C, got \"" + name + "\"");
  }
  if (trees.roots.empty()) throw ForestError("export_c: the forest is empty, train or load it first");
  const CTables tables(trees);
  const std::string inputs = std::to_string(trees.inputs);
  const std::string outputs = std::to_string(trees.outputs);
  const std::string tree_count = std::to_string(trees.roots.size());
  const std::uint32_t widest = tables.nodes.empty() ? 0 : *std::max_element(tables.nodes.begin(), tables.nodes.end());
  const std::string node_type = widest < 0x100U ? "uint8_t" : widest < 0x10000U ? "uint16_t" : "uint32_t";
  char scale[40];
  std::snprintf(scale, sizeof scale, "%.17g", 1.0 / static_cast<double>(trees.roots.size()));
  std::string code =
      "/* Regression forest: " + inputs + " inputs, " + outputs + " outputs, " + tree_count + " trees, " +
      std::to_string(trees.leaves) + " leaves of kind " + std::to_string(leaf_tag) + ". Written by surefoot. */\n" +
      "#include <stdint.h>\n\n" + "/* inner nodes of each tree */\n" + "static const uint32_t " + name +
      "_trees[] = " + c_list(std::span(tables.trees), "%u") + ";\n\n" +
      "/* of each inner node, depth first: (inner nodes below its left child) * inputs + its input */\n" +
      "static const " + node_type + " " + name + "_nodes[] = " + c_list(std::span(tables.nodes), "%u") + ";\n\n" +
      "/* floats: the threshold of each inner node, then the numbers of each leaf */\n" +
      c_numbers(tables.numbers, options.table, name) + "\n" +
      (options.wrapper.empty() ? "void " + name + "(const double in[" + inputs + "], double out[" + outputs + "]);\n"
                               : "") +
      (options.wrapper.empty() ? "" : "static ") + "void " + name + "(const double in[" + inputs + "], double out[" +
      outputs + "]) {\n" + "#define number(i) " + name + "_number(i)\n" + "  float x[" + inputs + "];\n" +
      "  uint32_t tree, o, k, first = 0, first_leaf = 0;\n" + "  for (k = 0; k < " + inputs +
      "; ++k) x[k] = (float)in[k];\n" + "  for (o = 0; o < " + outputs + "; ++o) out[o] = 0;\n" +
      "  for (tree = 0; tree < " + tree_count + "; ++tree) {\n" +
      "    uint32_t node = first, leaf = first_leaf, rest = " + name + "_trees[tree], p;\n" + "    first += rest;\n" +
      "    first_leaf += rest + 1;\n" + "    while (rest != 0) {\n" + "      const uint32_t left = " + name +
      "_nodes[node] / " + inputs + ";\n" + "      if (x[" + name + "_nodes[node] % " + inputs +
      "] > number(node)) {\n" + "        node += left + 1;\n" + "        leaf += left + 1;\n" +
      "        rest -= left + 1;\n" + "      } else {\n" + "        node += 1;\n" + "        rest = left;\n" +
      "      }\n" + "    }\n" + "    p = " + std::to_string(tables.nodes.size()) + " + leaf * " +
      std::to_string(trees.leaf_parameters) + ";\n" + indented(leaf_code, "    ") + "\n" + "  }\n" +
      "  for (o = 0; o < " + outputs + "; ++o) out[o] *= " + scale + ";\n" + "#undef number\n" + "}\n";
  if (!options.wrapper.empty()) code += "\n" + options.wrapper + (options.wrapper.ends_with('\n') ? "" : "\n");
  return code;
}

}  // namespace detail

/// The C file's text. Its function rounds the inputs to float, as predict does, and then does the same sums in the same
/// order: with IEEE doubles the outputs are equal to the last bit.
template <int Inputs, int Outputs, CLeafModel Leaf>
std::string export_c(const Forest<Inputs, Outputs, Leaf>& forest, const ExportCOptions& options = {}) {
  return detail::export_c(forest.raw(), Leaf::tag, Leaf::c_code(forest.inputs(), forest.outputs()), options);
}

}  // namespace surefoot

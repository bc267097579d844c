// The tables of a forest in a C file, and how they are spelled.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "surefoot/forest/export_c_options.hpp"
#include "surefoot/forest/short_floats.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

/// The tables of a forest in depth-first order. A descent needs only how many inner nodes lie left of a node: right of
/// it go the rest, and among the leaves of a tree the one reached is known by how many inner nodes it passed on its
/// right.
struct CTables {
  std::vector<std::uint32_t> trees;    // inner nodes of each tree
  std::vector<std::uint32_t> left;     // of each inner node: inner nodes below its left child
  std::vector<int> inputs;             // of each inner node
  std::vector<float> thresholds;       // of each inner node
  std::vector<std::uint32_t> numbers;  // bits of floats: those of each leaf

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
        const std::size_t below = i + node.distance();
        left.push_back(inner[below]);
        inputs.push_back(node.input());
        thresholds.push_back(node.threshold());
        open.push_back(below + 1);
        open.push_back(below);
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
template <class Number>
std::string c_list(std::span<const Number> items, const char* format) {
  std::string list = "{";
  std::size_t line = 0;
  for (const Number item : items) {
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

/// The table of numbers, given by their bits, and to read it `static uint32_t NAME_bits(uint32_t i)` and
/// `static TYPE NAME_number(uint32_t i)`. As text, short floats (see short_floats.hpp) take three characters each.
inline std::string c_numbers(const std::vector<std::uint32_t>& numbers, CTable table, const std::string& name,
                             const std::string& type = "float", bool short_floats = false) {
  const std::string head = "static uint32_t " + name + "_bits(uint32_t i) {\n";
  const std::string tail = "}\n\nstatic " + type + " " + name + "_number(uint32_t i) {\n  union { uint32_t bits; " +
                           type + " value; } n;\n  n.bits = " + name + "_bits(i);\n  return n.value;\n}\n";
  if (table == CTable::integers) {
    return "static const uint32_t " + name + "_numbers[] = " + c_list(std::span<const std::uint32_t>(numbers), "0x%x") +
           ";\n\n" + head + "  return " + name + "_numbers[i];\n" + tail;
  }
  // Base 85, most significant digit first; '"', '\' and '?' are left out. C99 promises 4095 characters per literal.
  constexpr std::size_t row = 800;
  const std::size_t length = short_floats ? 3 : 5;
  const std::string digits_each = std::to_string(length);
  std::string rows;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i % row == 0) rows += i == 0 ? "\"" : "\",\n\"";
    std::uint32_t rest = short_floats ? numbers[i] >> dropped_bits : numbers[i];
    char digits[5];
    for (std::size_t k = length; k-- > 0; rest /= 85) {
      char digit = static_cast<char>('#' + rest % 85);
      if (digit >= '?') ++digit;
      if (digit >= '\\') ++digit;
      digits[k] = digit;
    }
    rows.append(digits, length);
  }
  return "static const char " + name + "_numbers[][" + std::to_string(length * row + 1) + "] = {\n" + rows +
         "\"};\n\n" + head + "  const char *text = " + name + "_numbers[i / " + std::to_string(row) + "] + i % " +
         std::to_string(row) + " * " + digits_each +
         ";\n  uint32_t bits = 0;\n  int k;\n"
         "  for (k = 0; k < " +
         digits_each +
         "; ++k) bits = bits * 85 + (uint32_t)(text[k] - '#' - (text[k] > '?') - (text[k] > "
         "'\\\\'));\n"
         "  return bits" +
         (short_floats ? " << " + std::to_string(dropped_bits) : std::string()) + ";\n" + tail;
}

}  // namespace surefoot::detail

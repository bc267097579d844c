// A tree as nested if and else in C: no table of nodes to read, several times the code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <utility>

#include "surefoot/core/error.hpp"
#include "surefoot/forest/c/c_tables.hpp"

namespace surefoot::detail {

constexpr int c_deepest = 120;  // C99 promises 127 blocks inside each other

/// Writes functions `static uint32_t NAME_tree0(const TYPE *x)`, one per tree, that give the leaf's number among those
/// of all trees. `fixed`: the thresholds as whole numbers, empty: floats.
class CBranches {
 public:
  CBranches(const CTables& tables, std::span<const std::int32_t> fixed) : tables_(tables), fixed_(fixed) {}

  std::string code(const std::string& name, const std::string& type) {
    for (std::size_t tree = 0; tree < tables_.trees.size(); ++tree) {
      code_ += "static uint32_t " + name + "_tree" + std::to_string(tree) + "(const " + type + " *x) {\n";
      if (tables_.trees[tree] == 0) code_ += "  (void)x;\n";
      write(tables_.trees[tree], 0);
      code_ += "}\n\n";
    }
    return std::move(code_);
  }

 private:
  // The next subtree, of so many inner nodes.
  void write(std::uint32_t inner, int depth) {
    if (depth > c_deepest) {
      throw ForestError("export_c: a tree is deeper than " + std::to_string(c_deepest) +
                        " levels, too deep for nested ifs; use tables");
    }
    const std::string indent(static_cast<std::size_t>(depth % 40) + 2, ' ');
    if (inner == 0) {
      code_ += indent + "return " + std::to_string(leaf_++) + ";\n";
      return;
    }
    const std::size_t node = node_++;
    const std::uint32_t left = tables_.left[node];
    code_ += indent + "if (!(x[" + std::to_string(tables_.inputs[node]) + "] > " + threshold(node) + ")) {\n";
    write(left, depth + 1);
    code_ += indent + "} else {\n";
    write(inner - 1 - left, depth + 1);
    code_ += indent + "}\n";
  }

  std::string threshold(std::size_t node) const {
    if (!fixed_.empty()) return std::to_string(fixed_[node]);
    char text[40];
    std::snprintf(text, sizeof text, "%af", static_cast<double>(tables_.thresholds[node]));
    return text;
  }

  const CTables& tables_;
  std::span<const std::int32_t> fixed_;
  std::string code_;
  std::size_t node_ = 0;  // next in depth-first order
  std::size_t leaf_ = 0;
};

}  // namespace surefoot::detail

// The text of a forest in C.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "surefoot/forest/c/c_agreement.hpp"
#include "surefoot/forest/c/c_branches.hpp"
#include "surefoot/forest/c/c_fixed_point.hpp"
#include "surefoot/forest/c/c_nodes.hpp"
#include "surefoot/forest/c/c_tables.hpp"
#include "surefoot/forest/c/c_whole_leaves.hpp"
#include "surefoot/forest/export_c_options.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

inline std::string indented(std::string_view code, const std::string& by) {
  std::string out = by;
  for (const char c : code) {
    out += c;
    if (c == '\n') out += by;
  }
  return out;
}

/// Writes the C file of one forest.
class CWriter {
 public:
  CWriter(const Trees& trees, std::uint32_t leaf_tag, const std::string& leaf_code, const ExportCOptions& options)
      : options_(options),
        name_(options.function),
        inputs_(std::to_string(trees.inputs)),
        outputs_(std::to_string(trees.outputs)),
        trees_(std::to_string(trees.roots.size())),
        leaf_code_(leaf_code),
        leaf_parameters_(std::to_string(trees.leaf_parameters)),
        head_("/* Regression forest: " + inputs_ + " inputs, " + outputs_ + " outputs, " + trees_ + " trees, " +
              std::to_string(trees.leaves) + " leaves of kind " + std::to_string(leaf_tag) +
              ". Written by surefoot. */\n"),
        width_(static_cast<std::uint32_t>(trees.inputs)),
        from_(trees),
        nodes_(trees, options.thresholds != CThreshold::float32),
        tables_(trees) {
    if (options.thresholds != CThreshold::float32) {
      whole_ = options.thresholds == CThreshold::int16 ? "int16_t" : "int32_t";
      scales_ = c_scales(tables_, trees.inputs, options.thresholds, options.largest_inputs);
      fixed_ = c_fixed_thresholds(tables_, scales_);
    }
    short_ = options.table == CTable::text && !options.whole_outputs && trees.leaves < (1U << (32 - dropped_bits)) &&
             std::all_of(tables_.numbers.begin(), tables_.numbers.end(), is_short) &&
             std::all_of(tables_.thresholds.begin(), tables_.thresholds.end(),
                         [](float threshold) { return is_short(std::bit_cast<std::uint32_t>(threshold)); });
    if (options.whole_outputs) whole_leaves_ = c_whole_leaves(trees, nodes_, leaf_tag, options.thresholds, scales_);
  }

  std::string code() const {
    std::string code = head_ + "#include <stdint.h>\n\n";
    if (!whole_.empty()) code += input_code();
    code += options_.descent == CDescent::tables ? node_tables() : branches();
    if (options_.whole_outputs) code += output_code();
    code += options_.whole_outputs ? whole_function() : function();
    if (!options_.wrapper.empty()) code += "\n" + options_.wrapper + (options_.wrapper.ends_with('\n') ? "" : "\n");
    return code;
  }

 private:
  bool numbers_hold_thresholds() const { return whole_.empty() && options_.descent == CDescent::tables; }

  static std::string digits(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
  }

  // How inputs become whole numbers.
  std::string input_code() const {
    const std::string limit = digits(c_limit(options_.thresholds));
    const std::string head = whole_ + " " + name_ + "_input(int input, double value)";
    return "/* Inputs are whole numbers: value * scale of the input, rounded. Where a value is farther than 1 / scale\n"
           "   from all thresholds, the leaves are those of the forest in floats. */\n"
           "static const double " +
           name_ + "_scales[" + inputs_ + "] = " + c_list(std::span<const double>(scales_), "%.17g") + ";\n\n" + head +
           ";\n" + head + " {\n" + "  const double scaled = value * " + name_ + "_scales[input];\n" +
           "  if (!(scaled > -" + limit + ")) return -" + limit + ";\n" + "  if (scaled >= " + limit + ") return " +
           limit + ";\n" + "  return (" + whole_ + ")(scaled < 0 ? scaled - 0.5 : scaled + 0.5);\n" + "}\n\n";
  }

  std::string node_tables() const {
    std::string code = "/* root of each tree */\nstatic const uint32_t " + name_ +
                       "_roots[] = " + c_list(std::span(nodes_.roots), "%u") + ";\n\n" +
                       "/* of each node: (nodes to its left child, of a leaf " +
                       (nodes_.words_name_leaves ? "its number" : "0") + ") << " + std::to_string(nodes_.input_bits) +
                       " | its input, of a leaf " + inputs_ + " */\nstatic const " + nodes_.word_type() + " " + name_ +
                       "_nodes[] = " + c_list(std::span<const std::uint32_t>(nodes_.words), "%u") + ";\n\n";
    if (!whole_.empty()) {
      std::vector<std::int32_t> fixed;
      for (std::size_t i = 0; i < nodes_.words.size(); ++i) {
        const std::uint32_t input = nodes_.input(i);
        fixed.push_back(input < width_ ? c_fixed(nodes_.thresholds[i], scales_[input]) : 0);
      }
      code += "static const " + whole_ + " " + name_ +
              "_thresholds[] = " + c_list(std::span<const std::int32_t>(fixed), "%d") + ";\n\n";
    }
    if (options_.whole_outputs) {
      const std::vector<std::uint32_t> numbers(whole_leaves_.numbers.begin(), whole_leaves_.numbers.end());
      code += "/* whole numbers: those of each leaf */\n" + c_numbers(numbers, options_.table, name_, "int32_t");
    } else {
      code += numbers_hold_thresholds()
                  ? "/* floats: the threshold of each node, then the numbers of each leaf; a leaf has its only number "
                    "in place of a\n   threshold, or the bits of its row */\n"
                  : "/* floats: the numbers of each leaf */\n";
      code += c_numbers(float_numbers(), options_.table, name_, "float", short_);
    }
    return code + "\n" +
           nodes_.descent(name_, whole_.empty() ? "float" : whole_, from_.inputs,
                          name_ + (whole_.empty() ? "_number(n)" : "_thresholds[n]"));
  }

  std::vector<std::uint32_t> float_numbers() const {
    std::vector<std::uint32_t> numbers;
    std::uint32_t leaf = 0;
    for (std::size_t i = 0; numbers_hold_thresholds() && i < nodes_.words.size(); ++i) {
      const bool inner = nodes_.input(i) < width_;
      numbers.push_back(inner ? std::bit_cast<std::uint32_t>(nodes_.thresholds[i])
                              : (from_.inline_leaves() ? nodes_.payloads[leaf]
                                 : short_              ? leaf << dropped_bits
                                                       : leaf));
      leaf += inner ? 0 : 1;
    }
    for (const std::uint32_t payload : nodes_.payloads) {
      if (from_.inline_leaves() && !numbers_hold_thresholds()) numbers.push_back(payload);
      const std::size_t count = from_.inline_leaves() ? 0 : from_.leaf_parameters;
      const float* row = from_.parameters.data() + payload * count;
      for (std::size_t k = 0; k < count; ++k) numbers.push_back(std::bit_cast<std::uint32_t>(row[k]));
    }
    return numbers;
  }

  std::string branches() const {
    const std::string type = whole_.empty() ? "float" : whole_;
    std::string code = "/* floats: the numbers of each leaf */\n" +
                       c_numbers(tables_.numbers, options_.table, name_, "float", short_) + "\n" +
                       CBranches(tables_, fixed_).code(name_, type) + "static uint32_t (*const " + name_ +
                       "_trees[])(const " + type + " *) = {";
    for (std::size_t tree = 0; tree < tables_.trees.size(); ++tree) {
      code += (tree == 0 ? "" : tree % 8 == 0 ? ",\n" : ", ") + name_ + "_tree" + std::to_string(tree);
    }
    return code + "};\n\n";
  }

  std::string function() const {
    const std::string head = "void " + name_ + "(const " + (whole_.empty() ? "double" : whole_) + " in[" + inputs_ +
                             "], double out[" + outputs_ + "])";
    // Leaves of constants do not look at x.
    const bool leaf_reads_x = leaf_code_.find("x[") != std::string::npos;
    const bool needs_x = whole_.empty() || leaf_reads_x;
    const std::string as_float = whole_.empty() ? "(float)in[k]" : "(float)(in[k] / " + name_ + "_scales[k])";
    std::string code = options_.wrapper.empty() ? head + ";\n" + head : "static " + head;
    code += " {\n#define number(i) " + name_ + "_number(i)\n";
    const bool tables = options_.descent == CDescent::tables;
    if (needs_x) code += "  float x[" + inputs_ + " + 1];\n";
    if (tables && !whole_.empty()) code += "  " + whole_ + " keys[" + inputs_ + " + 1];\n";
    code += std::string("  uint32_t tree, o, k") + (tables ? ", at[" + std::to_string(nodes_.lanes()) + "];\n" : ";\n");
    code += "  for (k = 0; k < " + inputs_ + "; ++k) {\n";
    if (needs_x) code += "    x[k] = " + as_float + ";\n";
    if (tables && !whole_.empty()) code += "    keys[k] = in[k];\n";
    code += "  }\n";
    if (tables)
      code += whole_.empty() ? "  x[" + inputs_ + "] = -3.402823466e38f;\n" : "  keys[" + inputs_ + "] = 0;\n";
    const bool agreeing = !options_.agreement.empty();
    if (agreeing) code += "  double proposals[" + trees_ + " * " + outputs_ + "] = {0};\n";
    code += "  for (o = 0; o < " + outputs_ + "; ++o) out[o] = 0;\n" + "  for (tree = 0; tree < " + trees_ +
            "; ++tree) {\n" + (options_.descent == CDescent::tables ? table_descent() : branch_descent()) +
            (agreeing ? "#define out (proposals + tree * " + outputs_ + ")\n" : std::string()) +
            indented(leaf_code_, "    ") + "\n" + (agreeing ? "#undef out\n" : "") + "  }\n" +
            (agreeing ? c_agreement(options_.agreement, tables_.trees.size())
                      : "  for (o = 0; o < " + outputs_ + "; ++o) out[o] *= " + share() + ";\n") +
            bounds() + "#undef number\n" + "}\n";
    return code;
  }

  // How outputs are read.
  std::string output_code() const {
    const std::string head = "double " + name_ + "_output(int output, int32_t value)";
    return "/* Outputs are whole numbers: value * scale of the output. */\nstatic const double " + name_ +
           "_output_scales[" + outputs_ + "] = " + c_list(std::span<const double>(whole_leaves_.scales), "%.17g") +
           ";\n\n" + head + ";\n" + head + " { return value / " + name_ + "_output_scales[output]; }\n\n";
  }

  std::string whole_function() const {
    const std::string head =
        "void " + name_ + "(const " + whole_ + " in[" + inputs_ + "], int32_t out[" + outputs_ + "])";
    const bool agreeing = !options_.agreement.empty();
    const auto each_output = [&](const std::string& does) {
      return "  for (o = 0; o < " + outputs_ + "; ++o) " + does + "\n";
    };
    std::string code = options_.wrapper.empty() ? head + ";\n" + head : "static " + head;
    code += " {\n#define number(i) " + name_ + "_number(i)\n  " + whole_ + " keys[" + inputs_ +
            " + 1];\n  uint32_t tree, o, k, at[" + std::to_string(nodes_.lanes()) + "];\n";
    if (agreeing) code += "  int32_t proposals[" + trees_ + " * " + outputs_ + "] = {0};\n";
    code += "  for (k = 0; k < " + inputs_ + "; ++k) keys[k] = in[k];\n  keys[" + inputs_ + "] = 0;\n" +
            each_output("out[o] = 0;") + "  for (tree = 0; tree < " + trees_ + "; ++tree) {\n" + table_descent() +
            (agreeing ? "#define out (proposals + tree * " + outputs_ + ")\n" : std::string()) +
            c_whole_leaf_code(whole_leaves_, from_.inputs, from_.outputs) + (agreeing ? "#undef out\n" : "") + "  }\n" +
            (agreeing ? c_whole_agreement(options_.agreement, whole_leaves_, tables_.trees.size())
                      : each_output("out[o] /= " + trees_ + ";"));
    if (!options_.low.empty()) {
      code +=
          each_output("{\n    static const int32_t low[" + outputs_ + "] = " + whole_bounds(options_.low) +
                      ";\n    static const int32_t high[" + outputs_ + "] = " + whole_bounds(options_.high) +
                      ";\n    if (out[o] < low[o]) out[o] = low[o];\n    if (out[o] > high[o]) out[o] = high[o];\n  }");
    }
    return code + "#undef number\n}\n";
  }

  std::string whole_bounds(const std::vector<double>& bounds) const {
    std::vector<std::int32_t> whole;
    for (std::size_t o = 0; o < bounds.size(); ++o) {
      constexpr double most = std::numeric_limits<std::int32_t>::max();
      whole.push_back(
          static_cast<std::int32_t>(std::clamp(std::round(bounds[o] * whole_leaves_.scales[o]), -most, most)));
    }
    return c_list(std::span<const std::int32_t>(whole), "%d");
  }

  std::string share() const { return digits(1.0 / static_cast<double>(tables_.trees.size())); }

  std::string bounds() const {
    if (options_.low.empty()) return {};
    return "  for (o = 0; o < " + outputs_ + "; ++o) {\n" + "    static const double low[" + outputs_ +
           "] = " + c_list(std::span<const double>(options_.low), "%.17g") + ";\n" + "    static const double high[" +
           outputs_ + "] = " + c_list(std::span<const double>(options_.high), "%.17g") + ";\n" +
           "    if (out[o] < low[o]) out[o] = low[o];\n" + "    if (out[o] > high[o]) out[o] = high[o];\n" + "  }\n";
  }

  std::string table_descent() const {
    const std::string lanes = std::to_string(nodes_.lanes()), end = "at[tree % " + lanes + "]";
    const std::string leaf =
        nodes_.words_name_leaves
            ? "(uint32_t)(" + name_ + "_nodes[" + end + "] >> " + std::to_string(nodes_.input_bits) + ")"
            : name_ + "_bits(" + end + ")" + (short_ ? " >> " + std::to_string(dropped_bits) : "");
    return "    uint32_t p;\n    if (tree % " + lanes + " == 0) " + name_ + "_leaves(" +
           (whole_.empty() ? "x" : "keys") + ", tree, " + trees_ + " - tree, at);\n    p = " +
           (!numbers_hold_thresholds() ? "(" + leaf + ") * " + leaf_parameters_
            : from_.inline_leaves()    ? end
                                    : std::to_string(nodes_.words.size()) + " + (" + leaf + ") * " + leaf_parameters_) +
           ";\n";
  }

  std::string branch_descent() const {
    return "    uint32_t p = " + name_ + "_trees[tree](" + (whole_.empty() ? "x" : "in") + ") * " + leaf_parameters_ +
           ";\n";
  }

  const ExportCOptions& options_;
  std::string name_, inputs_, outputs_, trees_, leaf_code_, leaf_parameters_, head_;
  std::uint32_t width_;  // number of inputs
  const Trees& from_;
  CNodes nodes_;
  CTables tables_;
  bool short_ = false;  // numbers are short and spelled as such
  std::string whole_;  // the C type of inputs that are whole numbers, or empty
  std::vector<double> scales_;
  std::vector<std::int32_t> fixed_;
  CWholeLeaves whole_leaves_;  // if outputs are whole numbers
};

}  // namespace surefoot::detail

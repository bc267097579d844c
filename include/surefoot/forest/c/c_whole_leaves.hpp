// Leaves and outputs as whole numbers in a C file, so that a controller without floating point computes none.
//
// Output o is a whole number, its value times a power of two, its scale, which leaves room for the sum over all trees.
// A linear leaf is (sum of slope * input) >> shift + constant, summed in 64 bits; slopes are rounded to 2^-shift.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/error.hpp"
#include "surefoot/forest/c/c_nodes.hpp"
#include "surefoot/forest/c/c_tables.hpp"
#include "surefoot/forest/export_c_options.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

struct CWholeLeaves {
  bool linear = false;
  std::vector<double> scales;         // of each output
  std::vector<int> shifts;            // of each output; linear leaves
  std::vector<std::int32_t> numbers;  // of each leaf: as in the forest, slopes scaled up by 2^shift
};

/// `input_scales`: see c_scales. Throws a ForestError if whole numbers cannot hold the leaves.
inline CWholeLeaves c_whole_leaves(const Trees& trees, const CNodes& nodes, std::uint32_t leaf_tag, CThreshold kind,
                                   std::span<const double> input_scales) {
  CWholeLeaves whole;
  whole.linear = leaf_tag == LinearLeaf::tag;
  if (!whole.linear && leaf_tag != ConstantLeaf::tag) {
    throw ForestError("export_c: whole_outputs is for constant and linear leaves, not for those of kind " +
                      std::to_string(leaf_tag));
  }
  const auto inputs = static_cast<std::size_t>(trees.inputs), outputs = static_cast<std::size_t>(trees.outputs);
  const std::size_t width = whole.linear ? inputs + 3 : 1;  // numbers per output: slopes, constant, bounds
  const auto number = [&](std::size_t leaf, std::size_t k) {
    const std::uint32_t payload = nodes.payloads[leaf];
    return static_cast<double>(trees.inline_leaves() ? std::bit_cast<float>(payload)
                                                     : trees.parameters[payload * trees.leaf_parameters + k]);
  };
  // Products of a slope and an input, and their sum, must fit into 64 bits.
  const int input_bits = kind == CThreshold::int16 ? 15 : 31;
  const int slope_bits = std::min(30, 62 - input_bits - static_cast<int>(std::bit_width(inputs)));
  for (std::size_t o = 0; o < outputs; ++o) {
    double largest = 0, steepest = 0;
    for (std::size_t leaf = 0; leaf < nodes.payloads.size(); ++leaf) {
      for (std::size_t k = 0; k < width; ++k) {
        const double size = std::abs(number(leaf, o * width + k));
        const bool slope = whole.linear && k < inputs;
        (slope ? steepest : largest) = std::max(slope ? steepest : largest, slope ? size / input_scales[k] : size);
      }
    }
    if (largest > 1e30) {
      throw ForestError("export_c: whole_outputs needs leaves that are clamped (LeafOptions::clamp)");
    }
    const double room = std::ldexp(1.0, 30) / static_cast<double>(trees.roots.size());
    const auto power = [](double ratio) { return std::clamp(std::ilogb(ratio), -60, 60); };
    int scale = largest > 0 ? power(room / largest) : 0;
    if (steepest > 0) scale = std::min(scale, power(std::ldexp(1.0, slope_bits) / steepest));
    whole.scales.push_back(std::ldexp(1.0, scale));
    const double slope_size = std::ldexp(steepest, scale);
    whole.shifts.push_back(steepest > 0 ? std::clamp(power(std::ldexp(1.0, slope_bits) / slope_size), 0, 31) : 0);
  }
  for (std::size_t leaf = 0; leaf < nodes.payloads.size(); ++leaf) {
    for (std::size_t o = 0; o < outputs; ++o) {
      for (std::size_t k = 0; k < width; ++k) {
        const bool slope = whole.linear && k < inputs;
        const double unit = slope ? std::ldexp(whole.scales[o], whole.shifts[o]) / input_scales[k] : whole.scales[o];
        whole.numbers.push_back(static_cast<std::int32_t>(std::lround(number(leaf, o * width + k) * unit)));
      }
    }
  }
  return whole;
}

/// What a leaf adds to out[], in C; its numbers start at number(p).
inline std::string c_whole_leaf_code(const CWholeLeaves& whole, int inputs, int outputs) {
  const std::string out = std::to_string(outputs), in = std::to_string(inputs);
  if (!whole.linear) return "    for (o = 0; o < " + out + "; ++o) out[o] += number(p + o);\n";
  const auto at = [&](int k) { return "number(p + " + std::to_string(inputs + k) + ")"; };
  return "    for (o = 0; o < " + out + "; ++o, p += " + std::to_string(inputs + 3) + ") {\n" +
         "      static const int shifts[" + out + "] = " + c_list(std::span<const int>(whole.shifts), "%d") + ";\n" +
         "      int64_t y = 0;\n" + "      for (k = 0; k < " + in + "; ++k) y += (int64_t)number(p + k) * in[k];\n" +
         "      y = (y >> shifts[o]) + " + at(0) + "; /* rounds down, on every compiler we know */\n" +
         "      if (y < " + at(1) + ") y = " + at(1) + ";\n" + "      if (y > " + at(2) + ") y = " + at(2) + ";\n" +
         "      out[o] += (int32_t)y;\n" + "    }\n";
}

/// As c_agreement, in whole numbers: distances in units of a 2^20th of an opinion.
inline std::string c_whole_agreement(const std::vector<double>& reach, const CWholeLeaves& whole, std::size_t trees) {
  std::vector<std::int32_t> near, weights;
  for (std::size_t o = 0; o < reach.size(); ++o) {
    near.push_back(static_cast<std::int32_t>(std::min(std::floor(reach[o] * whole.scales[o]), std::ldexp(1.0, 30))));
  }
  int digits = 40;  // of the weights, behind those of the distances: as many as 30 bits hold of the largest weight
  for (const std::int32_t most : near) digits = most > 0 ? std::min(digits, std::ilogb(most) + 10) : digits;
  for (const std::int32_t most : near) {  // a dimension without width has no say
    weights.push_back(most > 0 ? static_cast<std::int32_t>(std::lround(std::ldexp(1.0, 20 + digits) / most)) : 0);
  }
  std::string code = R"(  {
    static const int32_t reach[OUTPUTS] = REACH, weights[OUTPUTS] = WEIGHTS;
    uint64_t least = 0;
    uint32_t a, b, medoid = 0, agreeing = 0, near;
    for (a = 0; a < TREES; ++a) {
      uint64_t distances = 0;
      for (b = 0; b < TREES; ++b) {
        for (o = 0; o < OUTPUTS; ++o) {
          const int64_t difference = (int64_t)proposals[a * OUTPUTS + o] - proposals[b * OUTPUTS + o];
          distances += (uint64_t)(difference < 0 ? -difference : difference) * (uint64_t)weights[o] >> DIGITS;
        }
      }
      if (a == 0 || distances < least - (least >> 20)) {
        medoid = a;
        least = distances;
      }
    }
    for (a = 0; a < TREES; ++a) {
      near = 1;
      for (o = 0; o < OUTPUTS; ++o) {
        const int64_t difference = (int64_t)proposals[a * OUTPUTS + o] - proposals[medoid * OUTPUTS + o];
        if ((difference < 0 ? -difference : difference) > reach[o]) near = 0;
      }
      if (!near) continue;
      for (o = 0; o < OUTPUTS; ++o) out[o] += proposals[a * OUTPUTS + o];
      agreeing += 1;
    }
    for (o = 0; o < OUTPUTS; ++o) out[o] /= (int32_t)agreeing;
  }
)";
  const auto replace_all = [&code](const std::string& word, const std::string& by) {
    for (std::size_t at = 0; (at = code.find(word, at)) != std::string::npos; at += by.size()) {
      code.replace(at, word.size(), by);
    }
  };
  replace_all("OUTPUTS", std::to_string(reach.size()));
  replace_all("DIGITS", std::to_string(digits));
  replace_all("TREES", std::to_string(trees));
  replace_all("REACH", c_list(std::span<const std::int32_t>(near), "%d"));
  replace_all("WEIGHTS", c_list(std::span<const std::int32_t>(weights), "%d"));
  return code;
}

}  // namespace surefoot::detail

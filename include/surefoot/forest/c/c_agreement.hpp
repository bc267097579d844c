// One output from those of all trees, in C: what solve/agreement.hpp does, sum by sum.
#pragma once

#include <cstddef>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "surefoot/forest/c/c_tables.hpp"

namespace surefoot::detail {

/// Statements that turn `proposals`, tree after tree, into `out`. `reach`: per output.
inline std::string c_agreement(const std::vector<double>& reach, std::size_t trees) {
  char share[40];
  std::snprintf(share, sizeof share, "%.17g", 1.0 / static_cast<double>(trees));
  std::string code = R"(  {
    static const double reach[OUTPUTS] = REACH;
    double agreeing = 0, least = 0;
    uint32_t a, b, medoid = 0, near = 1;
    for (o = 0; o < OUTPUTS; ++o) {
      double low = proposals[o], high = proposals[o];
      for (a = 0; a < TREES; ++a) {
        const double one = proposals[a * OUTPUTS + o];
        out[o] += one;
        if (one < low) low = one;
        if (one > high) high = one;
      }
      if (!(high - low <= reach[o])) near = 0;
    }
    if (near) {
      for (o = 0; o < OUTPUTS; ++o) out[o] *= SHARE;
    } else {
      for (a = 0; a < TREES; ++a) {
        double distances = 0;
        for (b = 0; b < TREES; ++b) {
          for (o = 0; o < OUTPUTS; ++o) {
            const double difference = proposals[a * OUTPUTS + o] - proposals[b * OUTPUTS + o];
            if (reach[o] > 0) distances += (difference < 0 ? -difference : difference) / reach[o];
          }
        }
        if (a == 0 || distances < least * (1 - 1e-6)) {
          medoid = a;
          least = distances;
        }
      }
      for (o = 0; o < OUTPUTS; ++o) out[o] = 0;
      for (a = 0; a < TREES; ++a) {
        near = 1;
        for (o = 0; o < OUTPUTS; ++o) {
          const double difference = proposals[a * OUTPUTS + o] - proposals[medoid * OUTPUTS + o];
          if ((difference < 0 ? -difference : difference) > reach[o]) near = 0;
        }
        if (!near) continue;
        for (o = 0; o < OUTPUTS; ++o) out[o] += proposals[a * OUTPUTS + o];
        agreeing += 1;
      }
      for (o = 0; o < OUTPUTS; ++o) out[o] *= 1.0 / agreeing;
    }
  }
)";
  const auto replace_all = [&code](const std::string& word, const std::string& by) {
    for (std::size_t at = 0; (at = code.find(word, at)) != std::string::npos; at += by.size()) {
      code.replace(at, word.size(), by);
    }
  };
  replace_all("OUTPUTS", std::to_string(reach.size()));
  replace_all("TREES", std::to_string(trees));
  replace_all("SHARE", share);
  replace_all("REACH", c_list(std::span<const double>(reach), "%.17g"));
  return code;
}

}  // namespace surefoot::detail

// What was published or measured elsewhere for the two problems: mean cost of 10,000 trials.
#pragma once

#include <string_view>

namespace sigmaban {

/// Hofer and Rouxel, ICAPS 2017, table 3, and a near-optimal solution by dynamic programming on a dense grid
/// (70 million cells).
struct Published {
  double winner2016, tuned, rfpi;  // the paper's
  double near_optimal, near_optimal_half_width;
};

inline constexpr Published published_ha{31.84, 14.90, 11.88, 8.54, 0.07};
inline constexpr Published published_anha{44.12, 36.18, 15.97, 10.98, 0.08};
inline constexpr double published_core_hours = 120;  // of one RFPI training: 3 hours on 40 threads

inline const Published& published(std::string_view problem) { return problem == "ha" ? published_ha : published_anha; }

}  // namespace sigmaban

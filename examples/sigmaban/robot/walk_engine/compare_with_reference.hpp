// How far a walk engine is from a file of joint targets.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>

#include "reference_file.hpp"
#include "walk_engine.hpp"

namespace sigmaban {

struct ReferenceComparison {
  std::size_t reachable = 0;                   // rows both with targets
  std::size_t disagreements = 0;               // rows that only one of the two can reach
  const ReferenceRow* disagreement = nullptr;  // the first of them
  double largest_error = 0;                    // of any joint [rad]
  const ReferenceRow* worst = nullptr;         // the row where
  std::size_t joint = 0;                       // and which

  /// Every joint within `tolerance` [rad], and every row reachable by both or by none.
  bool agrees(double tolerance = 1e-9) const { return disagreements == 0 && largest_error <= tolerance; }
};

/// `make(parameters, phase)` gives the engine that is asked for each row. The result points into `rows`.
template <class Make>
  requires WalkEngine<std::invoke_result_t<Make, const WalkParameters&, double>>
ReferenceComparison compare_with_reference(std::span<const ReferenceRow> rows, Make make) {
  ReferenceComparison result;
  for (const ReferenceRow& row : rows) {
    auto engine = make(row.settings.parameters, row.phase);
    const std::optional<JointTargets> targets = engine.step(row.settings.orders, 0.0);
    if (targets.has_value() != row.reachable) {
      if (result.disagreements++ == 0) result.disagreement = &row;
      continue;
    }
    if (!targets) continue;
    ++result.reachable;
    const auto joints = targets->array();
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const double error = std::abs(joints[i] - row.joints[i]);
      if (result.worst == nullptr || !(error <= result.largest_error)) {
        result.largest_error = error;
        result.worst = &row;
        result.joint = i;
      }
    }
  }
  return result;
}

}  // namespace sigmaban

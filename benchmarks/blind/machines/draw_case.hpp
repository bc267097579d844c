// Cases of the blind benchmark from the grammar of machines.
#pragma once

#include <optional>

#include "../plants/case.hpp"
#include "draw_effects.hpp"

namespace machines {

/// When hidden physics counts as visible: errors of the calibrated model without it over those of the true model.
struct Visible {
  double held_out = 1.3;        // on recordings that were not fitted to
  double fitted = 1.15;         // on those fitted to, so that no luck with few recordings decides
  double held_out_each = 1.15;  // of two effects, while the other's strength is fitted, too
  double fitted_each = 1.08;
  double most = 80;  // beyond it nobody needs a diagnosis
};

/// What a draw of a case is made of; System::simulate and the faults refer to them.
struct Drawn {
  plants::Case one;
  std::shared_ptr<const CompiledMachine> machine;
  std::vector<Hidden> hidden;
};

/// The system that plants/calibrate.hpp and the writers work with: its faults are indices into `hidden`.
plants::System system_of(Random& random, const Draft& draft, std::shared_ptr<const CompiledMachine> machine);
plants::Fault fault_of(const Hidden& hidden, std::size_t index);
void set_hidden(plants::System& system, std::shared_ptr<const CompiledMachine> machine,
                const std::vector<Hidden>& hidden);

/// Whether the strength of an effect may be negative.
bool is_signed(const std::string& name);

/// All of `hidden` at work whatever faults are given, and the strength of hidden[k] as a last parameter.
plants::System with_free_strength(const plants::System& system, std::shared_ptr<const CompiledMachine> machine,
                                  const std::vector<Hidden>& hidden, std::size_t k);

/// Draws until the effects matter.
Drawn draw_case(Random& random, const Grammar& grammar, const std::string& family, plants::Kind kind);

}  // namespace machines

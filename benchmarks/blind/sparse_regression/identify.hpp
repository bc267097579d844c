// Identification of terms by sparse regression, component by component, and their errors in simulation.
#pragma once

#include <span>
#include <vector>

#include "machine.hpp"

namespace sparse {

struct Found {
  plants::Values coefficients;  // of machine.terms
  plants::Values importance;    // share of the residual that a term makes up, in root mean square
  bool significant = false;     // the terms lower the error on held-out rows by a twentieth
};

Found identify(const plants::System& system, const Machine& machine, const plants::Values& parameters,
               std::span<const plants::Recording> fit, std::span<const plants::Recording> check);

/// Candidate terms need sizes of the motion.
Sizes sizes_of_motion(const Machine& machine, const plants::Values& parameters,
                      std::span<const plants::Recording> recordings);

}  // namespace sparse

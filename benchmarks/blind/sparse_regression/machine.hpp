// The nominal equations of a family as regression needs them, and its library of candidate terms.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "plant.hpp"

namespace sparse {

using Triple = std::array<double, 3>;

/// One row of a recording.
struct Look {
  double time = 0;           // [s], or step
  Triple state{};            // one_dof: position, speed; levels: upper, lower; walk: pose
  Triple input{}, before{};  // before: a few rows earlier; for walks the previous command
};

enum class Motion { one_dof, levels, walk };

/// A candidate: what it adds to a component of the model.
struct Term {
  std::string effect, attached_to;
  std::size_t component = 0;
  std::function<double(const Look&)> value;
};

struct Machine {
  Motion motion = Motion::one_dof;
  std::size_t components = 1;  // regressed: acceleration; rates of the levels; displacement in the body frame
  /// The components as the nominal model has them.
  std::function<Triple(const plants::Values& parameters, const plants::Recording&, const Look&)> model;
  /// From what a term is (a force) to what a component is (an acceleration).
  std::function<double(const plants::Values& parameters, const plants::Recording&)> unit;
  std::vector<std::size_t> output_state;
  std::vector<Term> terms;
};

/// Sizes that the terms are scaled by.
struct Sizes {
  Triple state{}, reach{}, input{};  // root mean squares and largest magnitudes
};

Machine make_machine(const plants::System& system);
void add_terms(Machine& machine, const plants::System& system, const Sizes& sizes);

/// Inputs of a row.
Look look_at(const Machine& machine, const plants::Recording& recording, std::size_t row);

/// Outputs of the model with terms; `coefficients` in the order of machine.terms, empty for none.
std::vector<plants::Column> simulate(const Machine& machine, const plants::Values& parameters,
                                     const plants::Values& coefficients, const plants::Recording& recording);

}  // namespace sparse

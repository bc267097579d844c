// Simulation of a machine with any hidden physics: classical Runge-Kutta in small steps; dry friction by bristles that
// are brought up to date once per step, as are stops, gaps and overflows.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "formula.hpp"
#include "machine.hpp"

namespace machines {

/// A machine whose formulas are ready to be evaluated.
struct CompiledMachine {
  CompiledMachine(const Machine& description);

  Machine machine;
  std::vector<double> registers;                                                   // before anything is computed
  std::vector<int> inputs, signals, states, constants, parameters, drives, loads;  // registers; -1: none
  std::vector<Formula> signal_formulas, rates, efforts, outputs;                   // efforts: empty result -1: none
};

/// States and noise-free outputs at the rows; also the signals, in Series::states behind the states, if asked for.
plants::Series simulate(const CompiledMachine& machine, const Values& parameters, const std::vector<Hidden>& hidden,
                        const Recording& recording, const plants::How& how, bool with_signals = false);

}  // namespace machines

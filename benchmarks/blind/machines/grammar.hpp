// The grammar of machines: topologies, drives, controllers, parameters over realistic orders of magnitude, sensors and
// experiments, all drawn at random.
#pragma once

#include <string>
#include <vector>

#include "machine.hpp"

namespace machines {

/// What may be drawn. Some productions are kept for the examination: nobody looks at their cases while developing.
struct Grammar {
  bool examination = false;
  /// Share of the draws of an examination that take a production of its own where there is one.
  double own_productions = 0.6;
  bool linear_inputs = false;  // inputs that move in most rows go straight from row to row, not held

  bool draw_own(Random& random) const { return examination && random.chance(own_productions); }
};

/// A machine and the size of its inputs' excitation.
struct Draft {
  Machine machine;
  std::vector<double> initial;                                     // of the states; empty: zeros
  std::vector<double> initial_range;                               // by which recordings may differ from it
  int initial_meta = -1;                                           // constant of a recording that all states begin at
  std::vector<double> middle, swing;                               // of each input
  double duration = 1;                                             // of a recording [s]
  std::vector<std::pair<std::string, std::vector<double>>> metas;  // constants of a recording, values to choose from
};

/// Machines of the grammar by name.
const std::vector<std::string>& families();

Draft draw_machine(Random& random, const Grammar& grammar, const std::string& family);

Draft draw_chain(Random& random, const Grammar& grammar);
Draft draw_drive(Random& random, const Grammar& grammar);
Draft draw_tanks(Random& random, const Grammar& grammar);
Draft draw_heater(Random& random, const Grammar& grammar);
Draft draw_lift(Random& random, const Grammar& grammar);
Draft draw_rover(Random& random, const Grammar& grammar);

/// A parameter whose value in the model file is up to 30 % wrong, within bounds of decades.
plants::Parameter guess(Random& random, const std::string& name, const std::string& unit, double actual,
                        bool fixed = false);

/// Value with three significant digits.
double three_digits(double value);

/// Experiments: row times, inputs, initial values, constants.
std::vector<Recording> draw_recordings(Random& random, const Draft& draft);

/// The model file.
std::string model_toml(const Machine& machine, const std::vector<double>& noise, bool with_noise);

}  // namespace machines

// Hidden physics drawn for a machine: at any admissible place, of a size that might be seen.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grammar.hpp"
#include "simulate.hpp"

namespace machines {

/// Sizes of one quantity over the recordings of the machine without hidden physics.
struct Size {
  double spread = 0;  // standard deviation
  double rms = 0;
  double peak = 0;  // largest absolute value
  double rate = 0;  // root mean square of its rate [1/s]
  double low = 0, high = 0;
};

struct Sizes {
  std::vector<Size> states, inputs, signals, outputs;
  std::vector<double> forces;  // of states that forces act on: root mean square of rate times inertia
  double duration = 0;         // mean length of a recording [s]
};

Sizes measure(const CompiledMachine& machine, const std::vector<Recording>& recordings);

/// An effect and where it may be.
struct Candidate {
  std::string name;
  Where where = Where::speed;
  int target = 0;
};

/// Everything of the library that this machine might have.
std::vector<Candidate> named_candidates(const Machine& machine);
std::vector<Candidate> outside_candidates(const Machine& machine);

/// Whether any of its laws may be drawn.
bool is_open(const Grammar& grammar, const Candidate& candidate);

/// An effect of the candidate's name at its place, with a law and parameters drawn at random.
Hidden draw_hidden(Random& random, const Grammar& grammar, const Machine& machine, const Sizes& sizes,
                   const Candidate& candidate, const std::vector<double>& noise);

}  // namespace machines

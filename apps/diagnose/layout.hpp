// Which columns of a CSV file a simulator reads, and how its states start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model_file.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace diagnose_program {

/// The output that reads a state, as offset + slope * state; -1: none does.
struct ReadState {
  int output = -1;
  double offset = 0, slope = 1;
};

/// How to start a state: a value known before (an expression over constants), a measured one, or a guess.
struct StateStart {
  ModelState::Initial kind = ModelState::Initial::free;
  Formula formula;     // expression, or the name of a column
  ReadState measured;  // by the output that reads this state
  ReadState speed_of;  // by the one that reads the state whose rate this state is
  ReadState alike;     // by an output in the same unit, else by one that reads a state in the same unit
};

struct Layout {
  bool ode = true;
  std::string time;  // column; ode only
  std::vector<ModelInput> inputs;
  std::vector<std::string> outputs;  // columns
  std::vector<StateStart> starts;    // by state
  std::vector<ModelConstant> constants;
  std::string sequence;
  std::size_t skip_rows = 0;
  bool measured_after_step = false;
};

Layout layout_of(const ModelFile& model);

/// For a simulator in C++: columns are called name_unit ("goal_rad", "v_m_s"), the time t_s; a name that ends in its
/// unit already stays as it is. Every state is estimated from the data.
Layout layout_of(const surefoot::SimulatorInfo& info);

}  // namespace diagnose_program

// Simulation as a user of the model file has it: initial values that the file leaves free are fitted to the readings.
#pragma once

#include "simulate.hpp"

namespace machines {

/// As simulate(); with How::fit_free, free initial values are those of least squares, after Levenberg and Marquardt
/// from the true ones. `noise`: of each output, its weight.
plants::Series simulate_as_user(const CompiledMachine& machine, const Values& parameters,
                                const std::vector<Hidden>& hidden, const Recording& recording, const plants::How& how,
                                const std::vector<double>& noise);

}  // namespace machines

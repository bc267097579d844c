// Fit of parameters to readings: Gauss-Newton after Levenberg and Marquardt, derivatives by differences.
#pragma once

#include <span>
#include <vector>

#include "plant.hpp"

namespace plants {

/// Readings minus simulation, in standard deviations of the noise; missing readings and outliers are left out.
Column residuals(const System& system, const Values& parameters, const std::vector<Fault>& faults,
                 std::span<const Recording> recordings, const How& how);

/// Solves a x = b for symmetric positive a, by elimination with pivots.
Values solve(std::vector<Values> a, Values b);

/// Parameters that are not fixed, fitted from these values.
Values calibrate_from(const System& system, const Values& start, const std::vector<Fault>& faults,
                      std::span<const Recording> recordings, const How& how);

/// Parameters that are not fixed, from the nominal values and from the true ones; the better fit.
Values calibrate(const System& system, const std::vector<Fault>& faults, std::span<const Recording> recordings,
                 const How& how);

}  // namespace plants

// What is known of terms before anything is measured: bounds, sizes, how many there are to choose from.
#pragma once

#include "linearize.hpp"

namespace diagnose_robot {

/// Of the difference of two simulations of one model: what a term takes away must be more.
inline constexpr double times_numerical = 2;

/// Whether a term changes the motion of a joint.
bool moves(const Evidence& evidence, const Term& term, std::size_t joint);

/// Fills bounds, priors, costs and least sizes of a model whose `theta` and `independent` are known.
void set_priors(const Evidence& evidence, LinearModel& model);

}  // namespace diagnose_robot

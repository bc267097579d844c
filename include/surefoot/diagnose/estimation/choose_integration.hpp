// Choice of the integration: as coarse as the errors of the model allow.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "surefoot/diagnose/estimation/hypothesis.hpp"

namespace surefoot::diagnosis {

/// The cheapest integration whose error is small against the residuals of each output (5 %; `residual_size` in its
/// unit), tried on one recording.
Integration choose_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                               const Eigen::VectorXd& residual_size, const Integration& now, std::size_t recording);

/// The same where it is finer than now: what effects explain leaves smaller residuals. None where it is not.
std::optional<Integration> finer_integration(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                             const Eigen::VectorXd& residual_size, const Integration& now,
                                             std::size_t recording);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/choose_integration.ipp"
#endif

// Definitions of surefoot/motion/any_motion_model.hpp.
#pragma once

#include <Eigen/Core>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/motion/any_motion_model.hpp"

namespace surefoot {

SUREFOOT_INLINE AnyMotionModel AnyMotionModel::with_parameters(const Eigen::VectorXd& parameters) const {
  if (parameters.size() != parameter_count()) {
    throw MotionError("the model " + name() + " has " + std::to_string(parameter_count()) + " parameters, got " +
                      std::to_string(parameters.size()));
  }
  return {type_, parameters};
}

SUREFOOT_INLINE void AnyMotionModel::require_type(const detail::MotionModelType& type) const {
  if (type_ != &type) throw MotionError("the model is " + name() + ", not " + type.name);
}

}  // namespace surefoot

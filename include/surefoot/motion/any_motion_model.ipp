// Definitions of surefoot/motion/any_motion_model.hpp.
#pragma once

#include "surefoot/motion/any_motion_model.hpp"

#include <Eigen/Core>
#include <string>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/motion_error.hpp"

namespace surefoot {

SUREFOOT_INLINE AnyMotionModel AnyMotionModel::with_parameters(Eigen::VectorXd parameters) const {
  if (parameters.size() != parameter_count()) {
    throw MotionError("the model " + name() + " has " + std::to_string(parameter_count()) + " parameters, got " +
                      std::to_string(parameters.size()));
  }
  AnyMotionModel model = *this;
  model.parameters_ = std::move(parameters);
  return model;
}

SUREFOOT_INLINE void AnyMotionModel::require_type(const detail::MotionModelType& type) const {
  if (type_ != &type) throw MotionError("the model is " + name() + ", not " + type.name);
}

}  // namespace surefoot

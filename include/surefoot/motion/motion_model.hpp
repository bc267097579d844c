// The concept of a motion model: the displacement that really follows from the commands of a walk cycle (or of a
// control period of wheels).
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>

#include "surefoot/core/box.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/vec.hpp"

namespace surefoot {

/// Name, unit and reasonable range of one parameter of a model.
struct ModelParameter {
  std::string_view name, unit;
  double low = 0, high = 0;  // in that unit
};

/// A motion model maps the commanded displacement of one cycle (x, y, turn) [m, m, rad] to the displacement that
/// follows from it, in the frame before the cycle. A model is its parameters, a vector that calibration can search:
/// from_parameters(parameters()) moves alike.
/// The smallest conforming struct:
///
///   struct Scale {
///     static constexpr int parameter_count = 1;
///     static std::array<surefoot::ModelParameter, 1> parameter_info() { return {{{"scale", "1", 0.5, 2.0}}}; }
///     static Scale from_parameters(const surefoot::Vec<1>& p) { return {p[0]}; }
///     surefoot::Vec<1> parameters() const { return surefoot::Vec<1>(scale); }
///     surefoot::Pose2 displacement(const surefoot::Vec<3>& commands) const {
///       return surefoot::Pose2::from_vec(scale * commands);
///     }
///     double scale = 1;
///   };
///
/// A walk that is measured between two phases carries part of the last command: a model may ask for it by taking
/// `displacement(commands, previous)` instead, `previous` being the commands of the cycle before. A default-constructed
/// model is the one to start a calibration from: nothing is known of the robot, it does what it is told.
template <class M>
concept MotionModel = std::default_initializable<M> &&
    requires(const M& model, const Vec<3>& commands, const Vec<M::parameter_count>& parameters) {
  requires M::parameter_count >
  0;
  { M::parameter_info() } -> std::same_as<std::array<ModelParameter, std::size_t{M::parameter_count}>>;
  { M::from_parameters(parameters) } -> std::same_as<M>;
  { model.parameters() } -> std::same_as<Vec<M::parameter_count>>;
  requires requires {
    { model.displacement(commands) } -> std::same_as<Pose2>;
  } || requires {
    { model.displacement(commands, commands) } -> std::same_as<Pose2>;
  };
};

/// A compile error of one sentence about the first member that keeps M from being a MotionModel; the compiler quotes
/// the line with the declaration wanted (see explain_problem in core/problem.hpp).
template <class M>
auto explain_motion_model() {
  if constexpr (!std::default_initializable<M>) {
    return Incomplete<M>::default_constructor;  // M(): the model of a robot that does what it is told
  } else if constexpr (!requires {
                         requires M::parameter_count >
                         0;
                       }) {
    return Incomplete<M>::parameter_count;  // static constexpr int parameter_count: above 0
  } else if constexpr (!requires {
                         {
                           M::parameter_info()
                           } -> std::same_as<std::array<ModelParameter, std::size_t{M::parameter_count}>>;
                       }) {
    return Incomplete<M>::parameter_info;  // static std::array<surefoot::ModelParameter, parameter_count> of that name
  } else if constexpr (!requires(const Vec<M::parameter_count>& p) {
                         { M::from_parameters(p) } -> std::same_as<M>;
                       }) {
    return Incomplete<M>::from_parameters;  // static M from_parameters(const surefoot::Vec<parameter_count>&)
  } else if constexpr (!requires(const M& m) {
                         { m.parameters() } -> std::same_as<Vec<M::parameter_count>>;
                       }) {
    return Incomplete<M>::parameters;  // surefoot::Vec<parameter_count> parameters() const
  } else {
    return Incomplete<M>::displacement;  // surefoot::Pose2 displacement(const surefoot::Vec<3>& command) const
  }
}

/// Displacement of a cycle with these commands after one with the commands `previous`, by any model.
template <MotionModel M>
Pose2 cycle_displacement(const M& model, const Vec<3>& commands, const Vec<3>& previous) {
  if constexpr (requires { model.displacement(commands, previous); }) {
    return model.displacement(commands, previous);
  } else {
    return model.displacement(commands);
  }
}

/// What a model is called: its static member `name` if it has one, else "N parameters".
template <MotionModel M>
std::string model_name() {
  if constexpr (requires { std::string(M::name); }) {
    return std::string(M::name);
  } else {
    return std::to_string(M::parameter_count) + " parameters";
  }
}

/// The ranges of all parameters of a model.
template <MotionModel M>
Box<M::parameter_count> parameter_box() {
  Vec<M::parameter_count> low, high;
  Eigen::Index i = 0;
  for (const ModelParameter& parameter : M::parameter_info()) {
    low[i] = parameter.low;
    high[i++] = parameter.high;
  }
  return {low, high};
}

}  // namespace surefoot

// A motion model of any type: what the fits, monitors and plans work on, compiled once for all models.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/motion_model.hpp"

namespace surefoot {

namespace detail {

/// What is the same for all models of a type.
struct MotionModelType {
  std::string name;
  std::vector<ModelParameter> parameter_info;
  Box<Eigen::Dynamic> parameter_box;
  Eigen::VectorXd default_parameters;
  // Displacements of all cycles (column = cycle) of the model with these parameters.
  void (*displace)(const Eigen::VectorXd& parameters, const Eigen::Matrix3Xd& commands, const Vec<3>& command_before,
                   Eigen::Matrix3Xd& displacements);
};

template <MotionModel M>
const MotionModelType& motion_model_type() {
  static const MotionModelType type = [] {
    const auto info = M::parameter_info();
    const auto box = parameter_box<M>();
    return MotionModelType{.name = model_name<M>(),
                           .parameter_info = {info.begin(), info.end()},
                           .parameter_box = {Eigen::VectorXd(box.low()), Eigen::VectorXd(box.high())},
                           .default_parameters = M().parameters(),
                           .displace = [](const Eigen::VectorXd& parameters, const Eigen::Matrix3Xd& commands,
                                          const Vec<3>& before, Eigen::Matrix3Xd& displacements) {
                             const M model = M::from_parameters(Vec<M::parameter_count>(parameters));
                             displacements.resize(3, commands.cols());
                             Vec<3> previous = before;
                             for (Eigen::Index cycle = 0; cycle < commands.cols(); ++cycle) {
                               const Vec<3> command = commands.col(cycle);
                               displacements.col(cycle) = cycle_displacement(model, command, previous).vec();
                               previous = command;
                             }
                           }};
  }();
  return type;
}

}  // namespace detail

/// Any MotionModel converts to it.
class AnyMotionModel {
 public:
  template <MotionModel M>
  AnyMotionModel(const M& model)  // NOLINT(google-explicit-constructor): so that functions take any model
      : type_(&detail::motion_model_type<M>()), parameters_(model.parameters()) {}

  /// The model as its own type. Throws MotionError if it is of another.
  template <MotionModel M>
  M as() const {
    require_type(detail::motion_model_type<M>());
    return M::from_parameters(Vec<M::parameter_count>(parameters_));
  }

  const std::string& name() const { return type_->name; }
  const std::vector<ModelParameter>& parameter_info() const { return type_->parameter_info; }
  const Box<Eigen::Dynamic>& parameter_box() const { return type_->parameter_box; }
  const Eigen::VectorXd& default_parameters() const { return type_->default_parameters; }
  const Eigen::VectorXd& parameters() const { return parameters_; }
  Eigen::Index parameter_count() const { return parameters_.size(); }

  /// A model of the same type. Throws MotionError for another number of parameters.
  AnyMotionModel with_parameters(const Eigen::VectorXd& parameters) const;

  /// Displacements of all cycles with these commands (column = cycle) after the command `before`, each in the frame
  /// before its cycle (x, y, turn) [m, m, rad].
  Eigen::Matrix3Xd displacements(const Eigen::Matrix3Xd& commands, const Vec<3>& before) const {
    Eigen::Matrix3Xd result;
    displacements(commands, before, result);
    return result;
  }
  void displacements(const Eigen::Matrix3Xd& commands, const Vec<3>& before, Eigen::Matrix3Xd& result) const {
    type_->displace(parameters_, commands, before, result);
  }

  /// The same with other parameters, as many.
  void displacements(const Eigen::VectorXd& parameters, const Eigen::Matrix3Xd& commands, const Vec<3>& before,
                     Eigen::Matrix3Xd& result) const {
    type_->displace(parameters, commands, before, result);
  }

 private:
  AnyMotionModel(const detail::MotionModelType* type, const Eigen::VectorXd& parameters)
      : type_(type), parameters_(parameters) {}
  void require_type(const detail::MotionModelType& type) const;

  const detail::MotionModelType* type_;
  Eigen::VectorXd parameters_;
};

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/any_motion_model.ipp"
#endif

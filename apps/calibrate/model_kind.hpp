// The motion models to choose from, by the names of the command line.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/previous_command_correction.hpp"

namespace calibrate_program {

/// From few coefficients to many.
enum class ModelKind : std::uint8_t { proportional, simple, full, previous_command };

inline constexpr std::array<ModelKind, 4> all_models{ModelKind::proportional, ModelKind::simple, ModelKind::full,
                                                     ModelKind::previous_command};

inline constexpr std::string_view name_of(ModelKind kind) {
  constexpr std::array<std::string_view, 4> names{"proportional", "simple", "full", "previous-command"};
  return names[static_cast<std::size_t>(kind)];
}

/// The name in motion.json, whose words do not change.
inline constexpr std::string_view file_name_of(ModelKind kind) {
  return kind == ModelKind::previous_command ? "previous-order" : name_of(kind);
}

/// By either name.
inline std::optional<ModelKind> model_named(std::string_view name) {
  for (const ModelKind kind : all_models) {
    if (name_of(kind) == name || file_name_of(kind) == name) return kind;
  }
  return std::nullopt;
}

/// The model of that kind that does what it is told.
inline surefoot::AnyMotionModel default_model(ModelKind kind) {
  switch (kind) {
    case ModelKind::proportional:
      return surefoot::ProportionalCorrection();
    case ModelKind::simple:
      return surefoot::SimpleLinearCorrection();
    case ModelKind::full:
      return surefoot::FullLinearCorrection();
    case ModelKind::previous_command:
      break;
  }
  return surefoot::PreviousCommandCorrection();
}

/// Any of the models as the largest of them.
inline surefoot::PreviousCommandCorrection embedded(ModelKind kind, const Eigen::VectorXd& parameters) {
  if (kind == ModelKind::previous_command) {
    return surefoot::PreviousCommandCorrection::from_parameters(surefoot::Vec<21>(parameters));
  }
  // Where each coefficient stands among the twelve of the full model: row by row, four in a row.
  constexpr std::array<std::array<int, 6>, 2> places{{{1, 6, 11}, {0, 1, 4, 6, 8, 11}}};
  surefoot::Vec<21> all = surefoot::Vec<21>::Zero();
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    all[kind == ModelKind::full ? i : places[static_cast<std::size_t>(kind)][at]] = parameters[i];
  }
  return surefoot::PreviousCommandCorrection::from_parameters(all);
}

}  // namespace calibrate_program

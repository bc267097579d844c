// The motion models to choose from, by the names of the command line.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/previous_command_correction.hpp"

namespace calibrate_program {

/// From few coefficients to many.
enum class ModelKind : std::uint8_t { proportional, simple, full, previous_command };

inline constexpr std::array<ModelKind, 4> all_models{ModelKind::proportional, ModelKind::simple, ModelKind::full,
                                                     ModelKind::previous_command};

inline constexpr std::string_view name_of(ModelKind kind) {
  constexpr std::array<std::string_view, 4> names{"proportional", "simple", "full", "previous-order"};
  return names[static_cast<std::size_t>(kind)];
}

inline std::optional<ModelKind> model_named(std::string_view name) {
  for (const ModelKind kind : all_models) {
    if (name_of(kind) == name) return kind;
  }
  return std::nullopt;
}

/// Calls work.operator()<M>() with the model of that kind.
template <class Work>
auto with_model(ModelKind kind, Work&& work) {
  switch (kind) {
    case ModelKind::proportional:
      return work.template operator()<surefoot::ProportionalCorrection>();
    case ModelKind::simple:
      return work.template operator()<surefoot::SimpleLinearCorrection>();
    case ModelKind::full:
      return work.template operator()<surefoot::FullLinearCorrection>();
    case ModelKind::previous_command:
      break;
  }
  return work.template operator()<surefoot::PreviousCommandCorrection>();
}

/// Any of the models as the largest of them.
template <int Count>
surefoot::PreviousCommandCorrection embedded(const surefoot::LinearCorrection<Count>& model) {
  surefoot::Vec<21> parameters = surefoot::Vec<21>::Zero();
  for (Eigen::Index row = 0; row < 3; ++row) parameters.segment<4>(4 * row) = model.matrix().row(row);
  return surefoot::PreviousCommandCorrection::from_parameters(parameters);
}

inline surefoot::PreviousCommandCorrection embedded(const surefoot::PreviousCommandCorrection& model) { return model; }

}  // namespace calibrate_program

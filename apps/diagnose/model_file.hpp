// A model file (TOML): the equations of a machine as a user writes them, checked but not yet computed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "surefoot/diagnose/simulator.hpp"

namespace diagnose_program {

/// An expression, and where it stands, for messages.
struct Formula {
  std::string text;
  std::string place;  // "model.toml, line 12, [let] tau"
};

struct ModelInput {
  std::string name, column, unit;
  std::optional<surefoot::InputHold> hold = {};  // not said: as recordings show
  bool assumed = false;  // the unit was not to be found and is taken as 1
};

struct ModelLet {
  std::string name;
  Formula value;
};

struct ModelState {
  enum class Initial : std::uint8_t { formula, column, free };
  std::string name, unit;
  Formula change;  // rate (ode) or next value (map)
  Initial initial = Initial::formula;
  Formula start;  // expression over constants, or the name of a column
  std::optional<Formula> effort;
  std::string force, force_place;  // the name by which rates use the force on it; empty: none does
  std::string effort_unit;         // of effort times rate, or of the force
};

struct ModelOutput {
  std::string name, unit;  // the name is that of the column
  Formula value;
  double noise = std::numeric_limits<double>::quiet_NaN();
  double process_noise = std::numeric_limits<double>::quiet_NaN();
};

struct ModelConstant {
  std::string name;
  double value = 0;
  std::string meta;  // not empty: the key in the recording's first lines that holds the value
};

/// Names of states and lets; empty where not given.
struct ModelPlanar {
  std::string x, y, heading, forward, lateral, turn;
};

/// An effect that is part of the model already.
struct ModelEffect {
  std::string name, attached_to, with, form;
  std::vector<surefoot::ParameterInfo> parameters;
  std::string place;  // for messages
};

struct ModelFile {
  std::string file;  // for messages
  std::string name, time;
  surefoot::SimulatorKind kind = surefoot::SimulatorKind::ode;
  std::vector<ModelInput> inputs;
  std::vector<ModelLet> lets;
  std::vector<ModelState> states;
  std::vector<ModelOutput> outputs;
  std::vector<ModelConstant> constants;
  std::vector<surefoot::ParameterInfo> parameters;
  std::optional<ModelPlanar> planar;
  std::vector<ModelEffect> effects;
  std::string sequence;              // column whose changes part a file into recordings; empty: one recording
  std::size_t skip_rows = 0;         // at the beginning of each recording
  bool measured_after_step = false;  // map: the outputs of a row are those that its inputs led to
};

/// States, inputs, outputs, parameters and effects that a model may have at most, each.
inline constexpr std::size_t most_channels = 16, most_parameters = 64;

/// Throws surefoot::DiagnoseError: one sentence with file, line, table and key, and the cure.
ModelFile parse_model_file(std::string_view text, const std::string& file);
ModelFile read_model_file(const std::filesystem::path& path);

/// The checks that need all tables: every name once, every expression over names that are known where it stands.
/// parse_model_file() calls this.
void check_names(const ModelFile& model);

}  // namespace diagnose_program

// Single entries of the tables of a model file. Each throws surefoot::DiagnoseError for what it does not understand.
#pragma once

#include <cstddef>
#include <string>

#include "model_file.hpp"
#include "toml_table.hpp"

namespace diagnose_program {

/// Throws unless `name` can be used in expressions.
void check_new_name(const std::string& name, const std::string& where);

/// Throws if there are more than `most`.
void check_count(std::size_t count, const TomlTable& table, const std::string& what, std::size_t most);

ModelInput read_input(const TomlTable& table, const TomlEntry& entry);
ModelState read_state(const TomlTable& table, const TomlEntry& entry, bool ode);
ModelOutput read_output(const TomlTable& table, const TomlEntry& entry, bool ode);
ModelConstant read_constant(const TomlTable& table, const TomlEntry& entry);
surefoot::ParameterInfo read_parameter(const TomlTable& table, const TomlEntry& entry);

/// These read a whole table.
ModelEffect read_effect(const TomlTable& own);
ModelPlanar read_planar(const TomlTable& table);

}  // namespace diagnose_program

#include "model_file.hpp"

#include <cstddef>

#include "model_entries.hpp"
#include "read_toml.hpp"
#include "surefoot/core/binary.hpp"
#include "toml_table.hpp"
#include "units.hpp"

namespace diagnose_program {
namespace {

void read_head(const TomlTable& root, ModelFile& model) {
  allow_keys(root, {"schema", "name", "kind", "time", "sequence", "skip_rows", "measured", "inputs", "let", "states",
                    "outputs", "constants", "parameters", "planar", "effects"});
  const auto text = [&](const char* key, const char* what) { return required_text(root, key, what); };
  if (text("schema", "schema = \"surefoot.model/1\"") != "surefoot.model/1") {
    fail(place(root, *find(root, "schema"), "schema"), "only \"surefoot.model/1\" is known");
  }
  model.name = text("name", "what the machine is called");
  const std::string kind = text("kind", "\"ode\" or \"map\"");
  if (kind != "ode" && kind != "map") {
    fail(place(root, *find(root, "kind"), "kind"), in_quotes(kind) + " is no kind; \"ode\" or \"map\" is expected");
  }
  const bool ode = kind == "ode";
  model.kind = ode ? surefoot::SimulatorKind::ode : surefoot::SimulatorKind::map;
  if (ode) {
    model.time = text("time", "the column of the time, say time = \"t_s\"");
    if (unit_of_column(model.time) != "s") {
      fail(place(root, *find(root, "time"), "time"),
           "the column " + in_quotes(model.time) + " must be in seconds and end in '_s', like 't_s'");
    }
  } else if (find(root, "time") != nullptr) {
    fail(place(root, *find(root, "time"), "time"), "a map counts rows and has no time; remove this key");
  }
  if (find(root, "sequence") != nullptr) model.sequence = text("sequence", "");
  if (const toml::value* skip = find(root, "skip_rows")) {
    if (!skip->is_integer() || skip->as_integer() < 0)
      fail(place(root, *skip, "skip_rows"), "a whole number from 0 on is expected");
    model.skip_rows = static_cast<std::size_t>(skip->as_integer());
  }
  if (const toml::value* measured = find(root, "measured")) {
    const std::string when = to_text(*measured, place(root, *measured, "measured"));
    if (ode || (when != "before step" && when != "after step")) {
      fail(place(root, *measured, "measured"), "\"before step\" or \"after step\" is expected, of a map");
    }
    model.measured_after_step = when == "after step";
  }
}

template <class Item, class Read>
std::vector<Item> read_list(const TomlTable& root, const std::string& key, bool needed, std::size_t most,
                            const Read& read) {
  std::vector<Item> items;
  const toml::value* value = find(root, key);
  if (value == nullptr) {
    if (needed)
      throw surefoot::DiagnoseError(root.file + ": the table [" + key + "] is missing; every model needs one");
    return items;
  }
  TomlTable table = sub_table(root, {key, value}, "a table [" + key + "]");
  table.name = "[" + key + "]";
  for (const TomlEntry& entry : entries(table)) items.push_back(read(table, entry));
  if (needed && items.empty()) fail(place(table, *value), "the table is empty; every model needs an entry here");
  check_count(items.size(), table, "entries", most);
  return items;
}

ModelFile read_model(const TomlTable& root) {
  ModelFile model;
  model.file = root.file;
  read_head(root, model);
  const bool ode = model.kind == surefoot::SimulatorKind::ode;
  model.inputs = read_list<ModelInput>(root, "inputs", false, most_channels, read_input);
  model.lets = read_list<ModelLet>(root, "let", false, 200, [](const TomlTable& table, const TomlEntry& entry) {
    const std::string where = place(table, *entry.value, entry.key);
    check_new_name(entry.key, where);
    return ModelLet{entry.key, {to_formula(*entry.value, where), where}};
  });
  model.states = read_list<ModelState>(root, "states", true, most_channels,
                                       [ode](const TomlTable& t, const TomlEntry& e) { return read_state(t, e, ode); });
  model.outputs =
      read_list<ModelOutput>(root, "outputs", true, most_channels,
                             [ode](const TomlTable& t, const TomlEntry& e) { return read_output(t, e, ode); });
  model.constants = read_list<ModelConstant>(root, "constants", false, 200, read_constant);
  model.parameters = read_list<surefoot::ParameterInfo>(
      root, "parameters", false, most_parameters, [](const TomlTable& table, const TomlEntry& entry) {
        check_new_name(entry.key, place(table, *entry.value, entry.key));
        return read_parameter(table, entry);
      });
  if (const toml::value* planar = find(root, "planar")) {
    TomlTable table = sub_table(root, {"planar", planar}, "a table [planar]");
    table.name = "[planar]";
    if (ode) fail(place(table, *planar), "planar motion is for kind = \"map\" only; remove this table");
    model.planar = read_planar(table);
  }
  if (const toml::value* effects = find(root, "effects")) {
    if (!effects->is_array()) fail(place(root, *effects, "effects"), "[[effects]] with double brackets is expected");
    for (const toml::value& value : effects->as_array()) {
      if (!value.is_table()) fail(place(root, value, "effects"), "[[effects]] with double brackets is expected");
      model.effects.push_back(read_effect({&value, root.file, "[[effects]]"}));
    }
    check_count(model.effects.size(), root, "effects", most_channels);
  }
  return model;
}

}  // namespace

ModelFile parse_model_file(std::string_view text, const std::string& file) {
  const toml::value root = read_toml(text, file);
  if (!root.is_table())
    throw surefoot::DiagnoseError(file + ": the file is empty; a model has at least [states] and [outputs]");
  ModelFile model = read_model({&root, file, ""});
  check_names(model);
  return model;
}

ModelFile read_model_file(const std::filesystem::path& path) {
  const surefoot::Bytes bytes = surefoot::read_file(path);
  return parse_model_file({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.filename().string());
}

}  // namespace diagnose_program

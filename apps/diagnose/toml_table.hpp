// Reading TOML tables strictly: in the order of the file, with messages that name file, line, table and key.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <toml.hpp>
#include <vector>

#include "expression.hpp"
#include "names.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {

/// A table of the file, and how to name it: "[states] theta".
struct TomlTable {
  const toml::value* value = nullptr;
  std::string file, name;
};

struct TomlEntry {
  std::string key;
  const toml::value* value;
};

inline std::string place(const TomlTable& table, const toml::value& value, std::string_view key = {}) {
  std::string result = table.file + ", line " + std::to_string(value.location().line());
  if (!table.name.empty() || !key.empty()) result += ",";
  if (!table.name.empty()) result += " " + table.name;
  if (!key.empty()) result += " " + printable(key.substr(0, 60));
  return result;
}

[[noreturn]] inline void fail(const std::string& place, const std::string& what) {
  throw surefoot::DiagnoseError(place + ": " + what);
}

/// In the order of the file.
inline std::vector<TomlEntry> entries(const TomlTable& table) {
  struct Placed {
    std::size_t line, column;
    TomlEntry entry;
  };
  std::vector<Placed> placed;
  for (const auto& [key, value] : table.value->as_table()) {
    const auto location = value.location();
    placed.push_back({location.line(), location.column(), {key, &value}});
  }
  std::ranges::sort(placed, [](const Placed& a, const Placed& b) {
    return a.line != b.line ? a.line < b.line : a.column != b.column ? a.column < b.column : a.entry.key < b.entry.key;
  });
  std::vector<TomlEntry> result;
  for (Placed& one : placed) result.push_back(std::move(one.entry));
  return result;
}

inline const toml::value* find(const TomlTable& table, const std::string& key) {
  const auto& entries = table.value->as_table();
  const auto found = entries.find(key);
  return found == entries.end() ? nullptr : &found->second;
}

inline void allow_keys(const TomlTable& table, std::initializer_list<std::string_view> allowed) {
  const std::vector<std::string> names(allowed.begin(), allowed.end());
  for (const TomlEntry& entry : entries(table)) {
    if (std::ranges::find(names, entry.key) != names.end()) continue;
    fail(place(table, *entry.value), "unknown key " + in_quotes(entry.key) + suggestion(entry.key, names));
  }
}

inline TomlTable sub_table(const TomlTable& table, const TomlEntry& entry, const std::string& expected) {
  const std::string name = table.name + (table.name.empty() ? "" : " ") + printable(entry.key.substr(0, 60));
  if (!entry.value->is_table()) fail(place(table, *entry.value, entry.key), expected + " is expected");
  return {entry.value, table.file, name};
}

inline double to_number(const toml::value& value, const std::string& place) {
  double number = std::nan("");
  if (value.is_floating()) number = value.as_floating();
  if (value.is_integer()) number = static_cast<double>(value.as_integer());
  if (!std::isfinite(number)) fail(place, "a finite number is expected");
  return number;
}

inline std::string to_text(const toml::value& value, const std::string& place) {
  if (!value.is_string()) fail(place, "a text in quotes is expected");
  return value.as_string().str;
}

/// An expression: a text, or a number as it is.
inline std::string to_formula(const toml::value& value, const std::string& place) {
  if (value.is_string()) return value.as_string().str;
  if (value.is_floating() || value.is_integer()) return number_text(to_number(value, place));
  fail(place, "an expression in quotes is expected");
}

inline const toml::value& required(const TomlTable& table, const std::string& key, const std::string& what) {
  const toml::value* value = find(table, key);
  if (value == nullptr) fail(place(table, *table.value), "the key '" + key + "' is missing: " + what);
  return *value;
}

inline std::string required_text(const TomlTable& table, const std::string& key, const std::string& what) {
  const toml::value& value = required(table, key, what);
  return to_text(value, place(table, value, key));
}

inline double required_number(const TomlTable& table, const std::string& key, const std::string& what) {
  const toml::value& value = required(table, key, what);
  return to_number(value, place(table, value, key));
}

}  // namespace diagnose_program

#include "units.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace diagnose_program {
namespace {

using Unit = std::pair<std::string_view, std::string_view>;

// Ending of a column's name, and the unit as it is printed; longer endings are looked for first. Units per time are
// told from these: "m_s", "mL_min".
constexpr std::array<Unit, 65> units{{
    {"s", "s"},
    {"ms", "ms"},
    {"us", "us"},
    {"min", "min"},
    {"h", "h"},
    {"m", "m"},
    {"cm", "cm"},
    {"mm", "mm"},
    {"um", "um"},
    {"km", "km"},
    {"rad", "rad"},
    {"deg", "deg"},
    {"mrad", "mrad"},
    {"rev", "rev"},
    {"rpm", "rpm"},
    {"m_s2", "m/s^2"},
    {"rad_s2", "rad/s^2"},
    {"m3", "m^3"},
    {"m2", "m^2"},
    {"cm2", "cm^2"},
    {"cm3", "cm^3"},
    {"l", "l"},
    {"L", "L"},
    {"ml", "ml"},
    {"mL", "mL"},
    {"kg", "kg"},
    {"g", "g"},
    {"N", "N"},
    {"mN", "mN"},
    {"kN", "kN"},
    {"Nm", "N m"},
    {"N_m", "N m"},
    {"mNm", "mN m"},
    {"N_s", "N s"},
    {"Pa", "Pa"},
    {"kPa", "kPa"},
    {"bar", "bar"},
    {"V", "V"},
    {"mV", "mV"},
    {"kV", "kV"},
    {"A", "A"},
    {"mA", "mA"},
    {"W", "W"},
    {"kW", "kW"},
    {"J", "J"},
    {"kJ", "kJ"},
    {"C", "C"},
    {"degC", "C"},
    {"K", "K"},
    {"Hz", "Hz"},
    {"kHz", "kHz"},
    {"ohm", "ohm"},
    {"T", "T"},
    {"mol", "mol"},
    {"mol_l", "mol/l"},
    {"lx", "lx"},
    {"N_m2", "N/m^2"},
    {"pct", "%"},
    {"percent", "%"},
    {"norm", "1"},
    {"raw", "1"},
    {"ratio", "1"},
    {"counts", "1"},
    {"1", "1"},
    {"duty", "1"},
}};

// The longest of these endings of a column's name; empty if there is none.
Unit last_unit(std::string_view column) {
  Unit last;
  for (const Unit& one : units) {
    const std::string_view ending = one.first;
    const bool ends =
        column.size() > ending.size() && column.ends_with(ending) && column[column.size() - ending.size() - 1] == '_';
    if (ends && ending.size() > last.first.size()) last = one;
  }
  return last;
}

bool is_time(std::string_view unit) { return unit == "s" || unit == "min" || unit == "h"; }

// Letters and digits alone: "N m", "N.m" and "N*m" are the same.
std::string bare(std::string_view unit) {
  std::string result;
  for (const char c : unit) {
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '%') result += c;
  }
  return result;
}

// Whether the last words of a name are a unit as it is written with '_': "conc_g_l" and g/l, "heater_degC" and degC.
bool ends_in_words_of(std::string_view column, std::string_view unit) {
  for (std::size_t at = column.find('_'); at != std::string_view::npos; at = column.find('_', at + 1)) {
    if (bare(column.substr(at)) == bare(unit)) return true;
  }
  return false;
}

}  // namespace

std::string unit_of_column(std::string_view column) {
  const Unit last = last_unit(column);
  if (!is_time(last.second)) return std::string(last.second);
  const std::string_view before = last_unit(column.substr(0, column.size() - last.first.size() - 1)).second;
  const bool rate = !before.empty() && before != "1" && !is_time(before);
  return (rate ? std::string(before) + "/" : "") + std::string(last.second);
}

bool unit_fits(std::string_view column, std::string_view unit) {
  const std::string known = unit_of_column(column);
  if (known.empty() || known == "1" || unit == "1" || bare(known) == bare(unit)) return true;
  if (ends_in_words_of(column, unit)) return true;
  // A shorter ending may be the one that is meant: "order_m_s" in seconds.
  return std::ranges::any_of(units, [&](const auto& entry) {
    return column.ends_with("_" + std::string(entry.first)) && bare(entry.second) == bare(unit);
  });
}

}  // namespace diagnose_program

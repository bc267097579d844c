#include "csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "names.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t longest_quote = 40;  // characters of a cell shown in a message

[[noreturn]] void fail(const std::string& file, std::size_t line, const std::string& what) {
  throw surefoot::DiagnoseError(file + ", line " + std::to_string(line) + ": " + what);
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    cells.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return cells;
    begin = comma + 1;
  }
}

void read_meta(std::string_view line, std::map<std::string, std::string>& meta) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return;  // a remark
  meta[std::string(trimmed(line.substr(1, colon - 1)))] = trimmed(line.substr(colon + 1));
}

void read_header(std::string_view line, std::size_t number, Csv& csv) {
  const std::size_t other = line.find_first_of(";\t");
  if (other != std::string_view::npos && line.find(',') == std::string_view::npos) {
    const std::string mark = line[other] == ';' ? "semicolons" : "tabs";
    fail(csv.file, number,
         "cells are set apart by " + mark + "; save it with commas between cells, and decimal points");
  }
  for (const std::string_view cell : cells_of(line)) {
    const std::string place = "column " + std::to_string(csv.columns.size() + 1);
    if (cell.empty()) fail(csv.file, number, place + " has no name in the header; name it, with its unit at the end");
    const auto same = std::ranges::find(csv.columns, cell, &CsvColumn::name);
    if (same != csv.columns.end()) {
      fail(csv.file, number, "column " + in_quotes(cell) + " stands twice in the header; rename or remove one");
    }
    csv.columns.push_back({std::string(cell), {}, 0, {}});
  }
  const auto no_name = [](const CsvColumn& column) { return std::isfinite(number_or_nan(column.name)); };
  if (std::ranges::all_of(csv.columns, no_name)) {
    fail(csv.file, number, "there is no header row, only numbers; put the names of the columns above them");
  }
}

void read_row(std::string_view line, std::size_t number, Csv& csv) {
  const auto cells = cells_of(line);
  if (cells.size() != csv.columns.size()) {
    fail(csv.file, number,
         "the row has " + std::to_string(cells.size()) + " cells, but the header has " +
             std::to_string(csv.columns.size()) + "; complete or remove this row");
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    CsvColumn& column = csv.columns[i];
    const double value = number_or_nan(cells[i]);
    column.values.push_back(value);
    const bool missing = cells[i].empty() || cells[i] == "nan" || cells[i] == "NaN";
    if (std::isfinite(value) || missing || column.bad_line != 0) continue;
    column.bad_line = number;
    column.bad_cell = std::string(cells[i].substr(0, longest_quote));
  }
  csv.lines.push_back(number);
}

}  // namespace

double number_or_nan(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = nothing;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : nothing;
}

Csv parse_csv(std::string_view text, const std::string& file) {
  Csv csv;
  csv.file = file;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // mark that some programs put before UTF-8
  for (std::size_t begin = 0, number = 1; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (line.empty()) continue;
    if (csv.columns.empty() && line.starts_with('#')) {
      read_meta(line, csv.meta);
    } else if (csv.columns.empty()) {
      read_header(line, number, csv);
    } else {
      read_row(line, number, csv);
    }
  }
  if (csv.columns.empty()) {
    throw surefoot::DiagnoseError(file + ": the file is empty; a header row and rows of numbers are expected");
  }
  return csv;
}

Csv read_csv(const std::filesystem::path& path) {
  const surefoot::Bytes bytes = surefoot::read_file(path);
  return parse_csv({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.filename().string());
}

const std::vector<double>& numbers(const Csv& csv, const std::string& column, const std::string& why) {
  const auto found = std::ranges::find(csv.columns, column, &CsvColumn::name);
  if (found == csv.columns.end()) {
    std::vector<std::string> names;
    for (const CsvColumn& other : csv.columns) names.push_back(other.name);
    throw surefoot::DiagnoseError(csv.file + ": column " + in_quotes(column) + " is missing, " + why +
                                  "; the file has " + listed(names));
  }
  if (found->bad_line != 0) {
    fail(csv.file, found->bad_line,
         "column " + in_quotes(column) + " holds \"" + printable(found->bad_cell) +
             "\", which is no finite number; leave a cell empty where nothing was measured");
  }
  return found->values;
}

}  // namespace diagnose_program

// A CSV file of a recording: lines `# key: value`, a header row, numbers. Nothing is quoted; lines may end in CRLF.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace diagnose_program {

/// One column. A cell that is empty or `nan` is NaN; the first one that is no number is kept for the message, since
/// columns that a model does not use may hold anything.
struct CsvColumn {
  std::string name;
  std::vector<double> values;
  std::size_t bad_line = 0;  // 0: none
  std::string bad_cell;
};

struct Csv {
  std::string file;                         // for messages
  std::map<std::string, std::string> meta;  // the lines `# key: value`
  std::vector<CsvColumn> columns;
  std::vector<std::size_t> lines;  // by row: its line in the file, from 1

  std::size_t rows() const { return lines.size(); }
};

/// Throws surefoot::DiagnoseError that names the line.
Csv parse_csv(std::string_view text, const std::string& file);
Csv read_csv(const std::filesystem::path& path);

/// The numbers of a column. Throws if it is missing or holds a cell that is no number. `why` ends the sentence: what
/// the model wants the column for.
const std::vector<double>& numbers(const Csv& csv, const std::string& column, const std::string& why);

/// The number, or NaN if `text` is none.
double number_or_nan(std::string_view text);

}  // namespace diagnose_program

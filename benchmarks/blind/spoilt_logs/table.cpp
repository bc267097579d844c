#include "table.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace spoilt {

Table read_table(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  Table table;
  std::string line;
  while (std::getline(stream, line)) {
    if (line.rfind("#", 0) == 0) {
      table.remarks.push_back(line);
      continue;
    }
    std::stringstream cells(line + ",");
    std::string cell;
    const bool header = table.names.empty();
    for (std::size_t c = 0; std::getline(cells, cell, ','); ++c) {
      if (header) {
        table.names.push_back(cell);
      } else {
        table.columns[c].push_back(cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(cell));
      }
    }
    if (header) table.columns.resize(table.names.size());
  }
  return table;
}

void write_table(const Table& table, const std::filesystem::path& file) {
  std::ofstream stream(file);
  for (const std::string& remark : table.remarks) stream << remark << '\n';
  for (std::size_t c = 0; c < table.names.size(); ++c) stream << (c > 0 ? "," : "") << table.names[c];
  stream << '\n';
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      char text[32] = "";
      if (std::isfinite(table.columns[c][row])) std::snprintf(text, sizeof text, "%.9g", table.columns[c][row]);
      stream << (c > 0 ? "," : "") << text;
    }
    stream << '\n';
  }
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace spoilt

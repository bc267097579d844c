// A recording as a table of numbers, read from its file and written back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace spoilt {

struct Table {
  std::vector<std::string> remarks;        // lines before the header, as they are
  std::vector<std::string> names;          // of the columns
  std::vector<std::vector<double>> columns;  // NaN: an empty cell

  std::size_t rows() const { return columns.empty() ? 0 : columns[0].size(); }
};

Table read_table(const std::filesystem::path& file);
void write_table(const Table& table, const std::filesystem::path& file);

}  // namespace spoilt

// CSV files as recordings of a model.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "csv.hpp"
#include "layout.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {

struct LoadedRecordings {
  std::vector<surefoot::Recording> recordings;  // more than one if the file holds several sequences
  std::vector<surefoot::Remark> remarks;        // what is odd but no error
};

/// Throws surefoot::DiagnoseError that names file, line and column.
LoadedRecordings recordings_of(const Csv& csv, const Layout& layout);
LoadedRecordings load_recordings(const std::filesystem::path& path, const Layout& layout);

}  // namespace diagnose_program

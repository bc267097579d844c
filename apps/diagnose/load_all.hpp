// The recordings that a command line names.
#pragma once

#include <string>
#include <vector>

#include "command_line.hpp"
#include "layout.hpp"
#include "load_recording.hpp"

namespace diagnose_program {

/// Recordings of all files of the command line, those kept for the test too. A file that shares its name with one in
/// another folder goes by its whole path.
LoadedRecordings load_all(const CommandLine& line, const Layout& layout);

/// Remarks, those that several recordings share said once.
std::vector<surefoot::Remark> once_each(const std::vector<surefoot::Remark>& remarks);

/// Names of those recordings that --test names.
std::vector<std::string> test_names(const CommandLine& line, const std::vector<surefoot::Recording>& recordings);

}  // namespace diagnose_program

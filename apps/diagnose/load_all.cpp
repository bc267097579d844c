#include "load_all.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>

#include "names.hpp"

namespace diagnose_program {
namespace {

namespace fs = std::filesystem;

// A recording's name without "#3", the number of its sequence.
std::string file_of(const std::string& name) { return name.substr(0, name.rfind('#')); }

// --test may name a file by its path, a file by its name, or one sequence of it.
bool names_it(const std::string& test, const std::string& recording) {
  const std::string name = fs::path(test).filename().string();
  return recording == test || recording == name || file_of(recording) == test || file_of(recording) == name;
}

}  // namespace

LoadedRecordings load_all(const CommandLine& line, const Layout& layout) {
  std::vector<fs::path> files = line.recordings;
  for (const std::string& test : line.test) {
    const auto same = [&test](const fs::path& file) {
      return file == test || names_it(test, file.filename().string()) ||
             names_it(file_of(test), file.filename().string());
    };
    if (std::ranges::none_of(files, same)) files.emplace_back(test);
  }
  std::map<std::string, int> uses;
  std::set<fs::path> seen;
  for (const fs::path& file : files) {
    if (!seen.insert(file.lexically_normal()).second) {
      throw surefoot::DiagnoseError("the recording " + in_quotes(file.string()) + " is named twice; name it once");
    }
    ++uses[file.filename().string()];
  }
  LoadedRecordings all;
  for (const fs::path& file : files) {
    Csv csv = read_csv(file);
    if (uses[file.filename().string()] > 1) csv.file = file.string();  // two files of one name in different folders
    LoadedRecordings loaded = recordings_of(csv, layout);
    std::ranges::move(loaded.recordings, std::back_inserter(all.recordings));
    std::ranges::move(loaded.remarks, std::back_inserter(all.remarks));
  }
  all.remarks = once_each(all.remarks);
  return all;
}

std::vector<surefoot::Remark> once_each(const std::vector<surefoot::Remark>& remarks) {
  std::vector<surefoot::Remark> result;
  std::set<std::string> said;
  for (const surefoot::Remark& remark : remarks) {
    if (!said.insert(remark.text).second) continue;
    const auto times = std::ranges::count(remarks, remark.text, &surefoot::Remark::text);
    result.push_back(times == 1 ? remark
                                : surefoot::Remark{"", remark.text + ", in " + std::to_string(times) + " recordings"});
  }
  return result;
}

std::vector<std::string> test_names(const CommandLine& line, const std::vector<surefoot::Recording>& recordings) {
  std::vector<std::string> names;
  for (const std::string& test : line.test) {
    const std::size_t before = names.size();
    for (const surefoot::Recording& recording : recordings) {
      const bool listed_already = std::ranges::find(names, recording.name) != names.end();
      if (names_it(test, recording.name) && !listed_already) names.push_back(recording.name);
    }
    if (names.size() == before) throw surefoot::DiagnoseError("--test: there is no recording " + in_quotes(test));
  }
  if (!names.empty() && names.size() == recordings.size()) {
    throw surefoot::DiagnoseError("--test names every recording; at least one must be left to learn from");
  }
  return names;
}

}  // namespace diagnose_program

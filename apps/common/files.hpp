// Text files whose folder is made as needed.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "surefoot/core/binary.hpp"
#include "usage_error.hpp"

namespace example {

inline std::string read_text(const std::filesystem::path& path) {
  const surefoot::Bytes bytes = surefoot::read_file(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Makes the folder of `path` and throws UsageError if no file can be written there: better now than after the work.
inline void prepare_output(const std::filesystem::path& path) {
  std::error_code failed;
  const auto old = std::filesystem::status(path, failed);
  if (std::filesystem::exists(old) && !std::filesystem::is_regular_file(old)) {
    throw UsageError(path.string() + ": is a folder or a device, give the name of a plain file");
  }
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), failed);
  const std::filesystem::path aside = path.string() + ".part";
  const bool written = std::ofstream(aside, std::ios::binary).is_open();
  std::filesystem::remove(aside, failed);
  if (!written) throw UsageError(path.string() + ": cannot be written, choose a folder that you may write to");
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  prepare_output(path);
  surefoot::write_file_atomically(path, text);
}

}  // namespace example

// A place for a file that is gone when the test ends.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace surefoot::toy {

struct TemporaryFile {
  std::filesystem::path path;

  explicit TemporaryFile(const std::string& name)
      : path(std::filesystem::temp_directory_path() / ("surefoot_" + name + "_" + std::to_string(getpid()))) {
    remove();
  }
  ~TemporaryFile() { remove(); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

 private:
  void remove() const {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    std::filesystem::remove(path.string() + ".part", ignored);
  }
};

}  // namespace surefoot::toy

// A folder of one test for its files, removed at its end.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace surefoot::toy {

struct ScratchFolder {
  std::filesystem::path path;

  /// `name` is the test's own; processes do not share it.
  explicit ScratchFolder(const std::string& name)
      : path(std::filesystem::temp_directory_path() / ("surefoot_" + name + "_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() { std::filesystem::remove_all(path); }
};

}  // namespace surefoot::toy

// Runs the program sigmaban_approach of this build, in scratch folders.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace approach_program {

inline std::string program() { return SUREFOOT_BIN_DIR "/sigmaban_approach"; }

/// False where the example was not built because one of its packages is missing.
inline bool program_exists() { return std::filesystem::exists(program()); }

struct Outcome {
  std::string output;  // stdout and stderr together
  int code = 0;        // of the exit, as a shell gives it
};

inline Outcome run_command(const std::string& command) {
  Outcome result;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return {"popen failed", 127};
  std::array<char, 4096> buffer{};
  for (std::size_t count = 0; (count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    result.output.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

inline Outcome run(const std::string& arguments) { return run_command(program() + " " + arguments); }

/// Writes a file of this text.
inline void write_text(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

/// A new folder that goes away with everything in it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "surefoot-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace approach_program

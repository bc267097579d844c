// Work done in a process of its own, under limits, and killed or watched until it ends (POSIX).
#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

namespace faults {

/// A scratch folder of this test, removed at its end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "surefoot_faults_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder can be made: " + name);
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

struct Ending {
  int exit_code = -1;  // -1: killed
  int signal = 0;      // 0: not killed
};

inline Ending wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
  }
  if (WIFSIGNALED(status)) return {-1, WTERMSIG(status)};
  return {WEXITSTATUS(status), 0};
}

/// Runs job() in a child process, which ends with what it returns, or with 99 if it throws.
template <class Job>
pid_t start(const Job& job) {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process can be started");
  if (child > 0) return child;
  for (const int kind : {SIGABRT, SIGSEGV, SIGTERM}) std::signal(kind, SIG_DFL);  // those of the test runner
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  int code = 99;
  try {
    code = job();
  } catch (const std::exception&) {
  }
  _exit(code);
}

/// What a write does that would make a file longer than the limit.
enum class AtLimit { kills, fails };

/// No file of this process may become longer than `bytes`: the next byte kills it, or its write fails like on a full
/// disk. What it execs inherits this.
inline void limit_files(std::size_t bytes, AtLimit what) {
  std::signal(SIGXFSZ, what == AtLimit::kills ? SIG_DFL : SIG_IGN);
  const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
  setrlimit(RLIMIT_FSIZE, &limit);
}

}  // namespace faults

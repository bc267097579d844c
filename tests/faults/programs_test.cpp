// The writers of the programs, in the programs themselves: full disks and death at some bytes.
#include <doctest/doctest.h>
#include <fcntl.h>

#include <filesystem>
#include <string>
#include <vector>

#include "apps/common/files.hpp"
#include "apps/calibrate/motion_file/motion_file.hpp"
#include "surefoot/core/binary.hpp"
#include "tests/faults/child.hpp"

using namespace faults;
using surefoot::read_file;

namespace {

namespace fs = std::filesystem;

struct Command {
  std::vector<std::string> words;  // the first is the program
  std::string out;                 // the file it writes, in the scratch folder
};

/// `arguments` and `--out FILE`, output thrown away.
[[noreturn]] void become(const Command& command, const fs::path& out) {
  std::vector<std::string> words = command.words;
  words.front() = SUREFOOT_BIN_DIR "/" + words.front();
  words.insert(words.end(), {"--out", out.string()});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  execv(arguments.front(), arguments.data());
  _exit(97);
}

Ending run(const Command& command, const fs::path& out, std::size_t limit, AtLimit what) {
  return wait_for(start([&]() -> int {
    limit_files(limit, what);
    become(command, out);
  }));
}

}  // namespace

TEST_CASE("programs leave the old file or the new one") {
  const std::vector<Command> commands{
      {{"surefoot-calibrate", "simulate", "--final-only", "--sequences", "4"}, "walks.csv"},
      {{"sigmaban_approach", "train", "--problem", "ha", "--budget", "0.2"}, "ha.policy"},
  };
  for (const Command& command : commands) {
    CAPTURE(command.words.front());
    const Folder folder;
    const fs::path out = folder / command.out;
    constexpr std::size_t unlimited = 1U << 30U;
    REQUIRE(run(command, out, unlimited, AtLimit::kills).exit_code == 0);
    const surefoot::Bytes new_file = read_file(out);
    REQUIRE(new_file.size() > 100);
    const std::string old_text = "old";
    for (const std::size_t limit : {std::size_t{0}, std::size_t{1}, new_file.size() / 2, new_file.size() - 1}) {
      CAPTURE(limit);
      for (const AtLimit what : {AtLimit::kills, AtLimit::fails}) {
        surefoot::write_file_atomically(out, old_text);
        const Ending ending = run(command, out, limit, what);
        if (what == AtLimit::kills) {
          CHECK(ending.signal == SIGXFSZ);
        } else {
          CHECK(ending.exit_code == 2);
        }
        CHECK(example::read_text(out) == old_text);
      }
    }
    CHECK(run(command, out, unlimited, AtLimit::kills).exit_code == 0);
    CHECK(read_file(out).size() > 100);
  }
}

TEST_CASE("a motion file whose writer dies at any byte is the old one") {
  const Folder folder;
  const fs::path path = folder / "motion.json";
  const auto file = calibrate_program::read_motion_file(SUREFOOT_SOURCE_DIR "/tests/fixtures/0.1.0/motion.json");
  const std::size_t size = calibrate_program::motion_file_text(file).size();
  for (std::size_t limit = 0; limit < size; limit += 29) {
    example::write_text(path, "old");
    const Ending ending = wait_for(start([&] {
      limit_files(limit, AtLimit::kills);
      calibrate_program::write_motion_file(path, file);
      return 0;
    }));
    CHECK(ending.signal == SIGXFSZ);
    CHECK(example::read_text(path) == "old");
  }
  write_motion_file(path, file);
  CHECK(example::read_text(path).size() == size);
  CHECK(folder.files() == 1);
}

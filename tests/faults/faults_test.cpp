// The writers of the library: disks that are full, folders that must not be written to, and death at any byte.
#include <doctest/doctest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/residual_model.hpp"
#include "surefoot/forest/serialize.hpp"
#include "surefoot/optimize/cma_es_serialize.hpp"
#include "surefoot/solve/rfpi.hpp"
#include "tests/faults/child.hpp"
#include "tests/fixtures/answers.hpp"

using namespace faults;
using surefoot::Bytes;
using surefoot::read_file;

namespace {

namespace fs = std::filesystem;

/// What the disk answers when it is asked to flush a file: 0, or an error number.
std::function<int()> at_flush = [] { return 0; };

}  // namespace

/// In place of the system's, in this program.
extern "C" int fsync(int) {
  errno = at_flush();
  return errno == 0 ? 0 : -1;
}

namespace {

struct Writer {
  std::string name;
  std::function<void(const fs::path&)> write;
};

/// Every writer of the library, each with a file that is another one than "old".
const std::vector<Writer>& writers() {
  static const fs::path fixtures = SUREFOOT_SOURCE_DIR "/tests/fixtures/0.1.0";
  static const auto forest = surefoot::load<fixtures::LinearForest>(fixtures / "linear.forest");
  static const auto policy = surefoot::load_policy(fixtures::Slide{}, fixtures / "slide.policy");
  static const auto search = surefoot::load_cma_es_search(read_file(fixtures / "bowl.cma"), "bowl.cma");
  static const std::uint64_t fingerprint = surefoot::detail::rfpi_fingerprint(
      fixtures::Slide{}, fixtures::slide_options("any"), fixtures::slide_seed, std::span<const surefoot::Vec<2>>{});
  static const auto state = surefoot::load_checkpoint<fixtures::Slide>(fixtures / "slide.rfpi", fingerprint);
  static const surefoot::ResidualModel residual{{"a"}, {"b"}, Eigen::VectorXd::Ones(1), {}};
  static const std::vector<Writer> all{
      {"text", [](const fs::path& path) { surefoot::write_file_atomically(path, std::string(700, 'n')); }},
      {"forest", [](const fs::path& path) { save(forest, path); }},
      {"policy", [](const fs::path& path) { save_policy(path, policy); }},
      {"search", [](const fs::path& path) { surefoot::write_file_atomically(path, save(search)); }},
      {"checkpoint", [](const fs::path& path) { save_checkpoint(path, fingerprint, state); }},
      {"residual", [](const fs::path& path) { save_residual_model(residual, path); }}};
  return all;
}

Bytes bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

const Bytes old_file = bytes_of("what was there before");

/// 0 if the writer throws one of surefoot's errors that names the file, 1 if it throws nothing, 2 if another one.
int tries_in_vain(const Writer& writer, const fs::path& path) {
  try {
    writer.write(path);
  } catch (const surefoot::Error& error) {
    return std::string(error.what()).find(path.string()) != std::string::npos ? 0 : 2;
  } catch (...) {
    return 2;
  }
  return 1;
}

/// Leaves root's rights behind, for which no folder is closed.
void become_nobody() {
  constexpr uid_t nobody = 65534;
  if (getuid() == 0 && (setgid(nobody) != 0 || setuid(nobody) != 0)) _exit(98);
}

}  // namespace

TEST_CASE("a writer that dies at any byte leaves the old file, and what it leaves beside does not hinder the next") {
  for (const Writer& writer : writers()) {
    CAPTURE(writer.name);
    const Folder folder;
    const fs::path path = folder / "file";
    writer.write(path);
    const Bytes new_file = read_file(path);
    REQUIRE(new_file.size() > 30);
    const bool every_byte = &writer == &writers().front();  // they all write by the same function
    const std::size_t stride = every_byte ? 1 : 1 + new_file.size() / 60;
    int deaths = 0;
    for (std::size_t limit = 0; limit <= new_file.size(); limit += stride) {
      surefoot::write_file_atomically(path, std::span<const std::byte>(old_file));
      const Ending ending = wait_for(start([&] {
        limit_files(limit, AtLimit::kills);
        writer.write(path);
        return 0;
      }));
      CAPTURE(limit);
      if (limit < new_file.size()) {
        CHECK(ending.signal == SIGXFSZ);
        CHECK(read_file(path) == old_file);
        ++deaths;
      } else {
        CHECK(ending.exit_code == 0);
        CHECK(read_file(path) == new_file);
      }
      writer.write(path);
      CHECK(read_file(path) == new_file);
      CHECK(folder.files() == 1);
    }
    CHECK(deaths >= 30);
  }
}

TEST_CASE("a writer whose disk is full at any byte says so and leaves the old file alone") {
  for (const Writer& writer : writers()) {
    CAPTURE(writer.name);
    const Folder folder;
    const fs::path path = folder / "file";
    writer.write(path);
    const std::size_t size = read_file(path).size();
    surefoot::write_file_atomically(path, std::span<const std::byte>(old_file));
    for (std::size_t limit = 0; limit < size; limit += 1 + size / 40) {
      const Ending ending = wait_for(start([&] {
        limit_files(limit, AtLimit::fails);
        return tries_in_vain(writer, path);
      }));
      CAPTURE(limit);
      CHECK(ending.exit_code == 0);
      CHECK(read_file(path) == old_file);
      CHECK(folder.files() == 1);
    }
  }
}

TEST_CASE("a disk that is really full") {
  const Folder folder;
  constexpr int no_rights = 77;
  const Ending ending = wait_for(start([&] {
    const bool own = unshare(CLONE_NEWNS) == 0 || unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0;
    if (!own || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0) {
      return no_rights;
    }
    const fs::path path = folder / "file";
    surefoot::write_file_atomically(path, std::span<const std::byte>(old_file));
    const Writer too_long{"long",
                          [](const fs::path& p) { surefoot::write_file_atomically(p, std::string(1 << 20, 'n')); }};
    if (const int code = tries_in_vain(too_long, path); code != 0) return code;
    return read_file(path) == old_file && folder.files() == 1 ? 0 : 3;
  }));
  if (ending.exit_code == no_rights) {
    MESSAGE("skipped: this machine lets us mount no small disk");
    return;
  }
  CHECK(ending.exit_code == 0);
}

TEST_CASE("the new file is on the disk as a whole before it takes the place of the old one") {
  for (const Writer& writer : writers()) {
    CAPTURE(writer.name);
    const Folder folder;
    const fs::path path = folder / "file";
    writer.write(path);
    const Bytes new_file = read_file(path);
    surefoot::write_file_atomically(path, std::span<const std::byte>(old_file));
    int flushes = 0, answer = EIO;
    at_flush = [&] {
      ++flushes;
      CHECK(read_file(path) == old_file);
      CHECK(read_file(folder / "file.part") == new_file);
      return answer;
    };
    CHECK(tries_in_vain(writer, path) == 0);  // a disk that fails only then
    CHECK(read_file(path) == old_file);
    CHECK(folder.files() == 1);
    answer = EINVAL;  // nothing to flush to, like a pipe
    writer.write(path);
    CHECK(read_file(path) == new_file);
    CHECK(flushes == 2);
    at_flush = [] { return 0; };
  }
}

TEST_CASE("a folder that is not there, is a file, or must not be written to") {
  const Folder folder;
  fs::permissions(folder.path(), fs::perms::owner_all | fs::perms::group_exec | fs::perms::others_exec |
                                     fs::perms::group_read | fs::perms::others_read);
  const fs::path closed = folder / "closed", plain = folder / "plain";
  fs::create_directory(closed);
  for (const fs::path& path : {closed / "file", plain}) {
    surefoot::write_file_atomically(path, std::span<const std::byte>(old_file));
  }
  fs::permissions(closed,
                  fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
  for (const Writer& writer : writers()) {
    CAPTURE(writer.name);
    CHECK(tries_in_vain(writer, folder / "none" / "file") == 0);
    CHECK(tries_in_vain(writer, plain / "file") == 0);
    CHECK(tries_in_vain(writer, closed) == 0);
    const Ending ending = wait_for(start([&] {
      become_nobody();
      return tries_in_vain(writer, closed / "file");
    }));
    CHECK(ending.exit_code == 0);
  }
  CHECK(read_file(closed / "file") == old_file);
  CHECK(read_file(plain) == old_file);
  CHECK(folder.files() == 2);
  fs::permissions(closed, fs::perms::owner_all);
}

TEST_CASE("a device is not replaced by a file, whoever asks for it") {
  const Folder folder;
  const fs::path pipe = folder / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  for (const Writer& writer : writers()) {
    CAPTURE(writer.name);
    CHECK(tries_in_vain(writer, pipe) == 0);
  }
  CHECK(fs::is_fifo(pipe));
  CHECK(folder.files() == 1);
}

TEST_CASE("a writer that is killed at any time leaves one file or the other") {
  const Folder folder;
  const fs::path path = folder / "file";
  const std::string first(100'000, 'a'), second(300'000, 'b');
  surefoot::write_file_atomically(path, first);
  surefoot::Rng rng(1);
  int seconds = 0;
  for (int i = 0; i < 60; ++i) {
    const pid_t child = start([&] {
      for (bool turn = true;; turn = !turn) surefoot::write_file_atomically(path, turn ? second : first);
      return 0;
    });
    usleep(500 + rng.below(8000));
    kill(child, SIGKILL);
    CHECK(wait_for(child).signal == SIGKILL);
    const Bytes found = read_file(path);
    const bool is_second = found == bytes_of(second);
    CHECK((is_second || found == bytes_of(first)));
    seconds += is_second ? 1 : 0;
  }
  CHECK(seconds > 0);  // some of them did write
  surefoot::write_file_atomically(path, first);
  CHECK(read_file(path) == bytes_of(first));
  CHECK(folder.files() == 1);
}

TEST_CASE("a training that is killed again and again ends in the policy of one that was not") {
  const Folder folder;
  const auto options = [](const fs::path& checkpoint) {
    surefoot::RfpiOptions result = fixtures::slide_options(checkpoint);
    result.max_iterations = 8;
    result.checkpoint_seconds = 0;
    return result;
  };
  const auto learn = [&](const fs::path& checkpoint) {
    return surefoot::rfpi(fixtures::Slide{}, options(checkpoint), surefoot::Serial{}, fixtures::slide_seed);
  };
  const auto whole = learn(folder / "whole");
  surefoot::Rng rng(2);
  int kills = 0;
  for (bool finished = false; !finished && kills < 300;) {
    const pid_t child = start([&] {
      learn(folder / "killed");
      return 0;
    });
    usleep(1000 + rng.below(40'000) * static_cast<unsigned>(1 + kills / 10));
    kill(child, SIGKILL);
    finished = wait_for(child).exit_code == 0;
    kills += finished ? 0 : 1;
  }
  MESSAGE("killed " << kills << " times");
  CHECK(kills > 0);
  CHECK(fixtures::ask(learn(folder / "killed").policy) == fixtures::ask(whole.policy));
}

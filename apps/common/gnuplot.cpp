#include "gnuplot.hpp"

#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <filesystem>
#include <string>

#include "files.hpp"
#include "usage_error.hpp"

extern char** environ;

namespace example {
namespace {

std::string in_quotes(const std::filesystem::path& path) {
  std::string result = "'";
  for (const char c : path.string()) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

std::filesystem::path with(const std::filesystem::path& base, const char* ending) { return base.string() + ending; }

void run_gnuplot(const std::filesystem::path& script) {
  std::string program = "gnuplot", file = script.string();
  const std::array<char*, 3> arguments{program.data(), file.data(), nullptr};
  pid_t child = 0;
  int status = 0;
  const bool started = posix_spawnp(&child, "gnuplot", nullptr, nullptr, arguments.data(), environ) == 0;
  if (!started || waitpid(child, &status, 0) < 0 || (WIFEXITED(status) && WEXITSTATUS(status) == 127)) {
    throw UsageError(file + ": gnuplot cannot be started, install the Debian package gnuplot-nox");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw UsageError(file + ": gnuplot failed on this script, its complaint is above");
  }
}

}  // namespace

void draw(const std::filesystem::path& base, const std::string& commands, const std::string& data, int width,
          int height) {
  const std::filesystem::path data_file = with(base, ".dat"), script = with(base, ".gp");
  const std::string size = "size " + std::to_string(width) + "," + std::to_string(height);
  std::string text = "data = " + in_quotes(data_file) + "\n";
  for (const auto& [terminal, ending] : {std::pair{"svg enhanced background '#ffffff' font 'sans,13' ", ".svg"},
                                         std::pair{"pngcairo enhanced font 'sans,10' ", ".png"}}) {
    text += "set terminal " + (terminal + size) + "\nset output " + in_quotes(with(base, ending).string() + ".part") +
            "\n" + commands + "unset output\nreset\n";
  }
  write_text(data_file, data);
  write_text(script, text);
  run_gnuplot(script);
  for (const char* ending : {".svg", ".png"}) {
    std::filesystem::rename(with(base, ending).string() + ".part", with(base, ending));
  }
}

}  // namespace example

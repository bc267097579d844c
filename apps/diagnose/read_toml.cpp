#include "read_toml.hpp"

#include <algorithm>
#include <cstddef>
#include <sstream>

#include "../common/utf8.hpp"
#include "names.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {
namespace {

// The parser calls itself for every bracket inside another and every part of a dotted key. What people write stays far
// below these; the stack holds them also where frames are large (sanitizers). Brackets in strings count as others do,
// and so may hide some that are open: hence a limit of all.
constexpr std::ptrdiff_t most_open = 100, most_brackets = 1000, most_points = 500;

void check_depth(std::string_view text, const std::string& file) {
  std::ptrdiff_t open = 0, brackets = 0, points = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool opens = c == '[' || c == '{', closes = c == ']' || c == '}';
    brackets += opens;
    open = std::max<std::ptrdiff_t>(0, open + opens - closes);
    points = opens || closes || c == '=' || c == ',' || c == '\n' ? 0 : points + (c == '.');
    const std::string what = open > most_open           ? std::to_string(most_open) + " brackets are open"
                             : brackets > most_brackets ? std::to_string(most_brackets) + " brackets are opened"
                             : points > most_points ? std::to_string(most_points) + " points stand in a key or value"
                                                    : "";
    if (what.empty()) continue;
    throw surefoot::DiagnoseError(file + ", line " + std::to_string(example::line_of(text, i)) + ": more than " + what +
                                  "; no file needs as many, simplify it");
  }
}

}  // namespace

toml::value read_toml(std::string_view text, const std::string& file) {
  check_depth(text, file);
  // The parser reads past the end of strings that are no UTF-8.
  if (const std::size_t at = example::first_not_utf8(text); at < text.size()) {
    throw surefoot::DiagnoseError(file + ", line " + std::to_string(example::line_of(text, at)) +
                                  ": a byte that is no UTF-8 text; save the file with the encoding UTF-8");
  }
  try {
    std::istringstream stream{std::string(text)};
    return toml::parse(stream, file);
  } catch (const toml::exception& error) {
    const std::string what = error.what();
    std::string reason = what.substr(0, what.find('\n'));
    if (reason.starts_with("[error] ")) reason.erase(0, std::string_view("[error] ").size());
    throw surefoot::DiagnoseError(file + ", line " + std::to_string(error.location().line()) + ", column " +
                                  std::to_string(error.location().column()) + ": this is not valid TOML (" +
                                  printable(reason.substr(0, 120)) + ")");
  } catch (const std::exception& error) {
    const std::string what = error.what();
    throw surefoot::DiagnoseError(file + ": this is not valid TOML (" +
                                  printable(what.substr(0, std::min<std::size_t>(what.find('\n'), 120))) + ")");
  }
}

}  // namespace diagnose_program

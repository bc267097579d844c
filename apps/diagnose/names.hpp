// Names in messages: quoting, lists, and which known name a wrong one is near to.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace diagnose_program {

/// Control characters as '?', so that a message stays one line.
inline std::string printable(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return result;
}

inline std::string in_quotes(std::string_view name) { return "'" + printable(name.substr(0, 60)) + "'"; }

/// "a, b, c", cut where it gets long.
inline std::string listed(const std::vector<std::string>& names, std::size_t most = 12) {
  std::string result;
  for (std::size_t i = 0; i < names.size() && i < most; ++i) {
    result += (i == 0 ? "" : ", ") + printable(names[i].substr(0, 60));
  }
  return names.size() > most ? result + ", ..." : result;
}

/// Least number of letters to insert, remove or change that makes `b` of `a` (Levenshtein).
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// "; did you mean 'x'?" for the nearest known name, or the one that holds it, else "; known are ...".
inline std::string suggestion(std::string_view wrong, const std::vector<std::string>& known) {
  constexpr std::size_t telling = 4;  // letters that hardly stand in a name by chance
  wrong = wrong.substr(0, 60);
  std::vector<std::string> longer;
  for (const std::string& name : known) {
    if (wrong.size() >= telling && name.find(wrong) != std::string::npos) longer.push_back(name);
  }
  if (longer.size() == 1) return "; did you mean " + in_quotes(longer.front()) + "?";
  std::size_t best = 1 + wrong.size() / 3;
  const std::string* nearest = nullptr;
  for (const std::string& name : known) {
    const std::size_t distance = edit_distance(wrong, name);
    if (distance > best || (nearest != nullptr && distance == best)) continue;
    best = distance;
    nearest = &name;
  }
  if (nearest != nullptr) return "; did you mean " + in_quotes(*nearest) + "?";
  return known.empty() ? std::string() : "; known are " + listed(known);
}

}  // namespace diagnose_program

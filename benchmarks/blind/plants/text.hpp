// Numbers as text.
#pragma once

#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

namespace plants {

inline std::string text(double value, const char* format = "%.6g") {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

/// A list in one string, separated by blanks.
inline std::vector<std::string> words(const std::string& list) {
  std::istringstream stream(list);
  std::vector<std::string> result;
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

}  // namespace plants

// Servo ids on a command line: "1-20", "1,3,7-9".
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "../../../../apps/common/usage_error.hpp"

namespace example {

/// In the order given, 0 ... 252 each. Throws UsageError, also where an id comes twice.
inline std::vector<std::uint8_t> parse_ids(const std::string& text) {
  const auto fail = [&] { throw UsageError("ids " + text + ": expected numbers of 0 to 252 such as 1-20 or 1,3,7-9"); };
  const auto number = [&](std::string_view part) {
    int value = -1;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size() || value < 0 || value > 252) fail();
    return value;
  };
  std::vector<std::uint8_t> ids;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view part = std::string_view(text).substr(begin, end - begin);
    const std::size_t dash = part.find('-');
    const int first = number(part.substr(0, dash));
    const int last = dash == std::string_view::npos ? first : number(part.substr(dash + 1));
    if (last < first) fail();
    for (int id = first; id <= last; ++id) {
      if (std::find(ids.begin(), ids.end(), id) != ids.end()) {
        throw UsageError("ids " + text + ": " + std::to_string(id) + " is there twice; each servo has its own");
      }
      ids.push_back(static_cast<std::uint8_t>(id));
    }
    begin = end + 1;
  }
  return ids;
}

}  // namespace example

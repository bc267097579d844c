// Is a text UTF-8?
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace example {

/// The place of the first byte that is no part of a UTF-8 character (Unicode 15, table 3-7: no surrogates, no forms
/// that are longer than needed); text.size() if there is none.
inline std::size_t first_not_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0};
  };
  const auto follows = [&](std::size_t i, int count) {
    for (; count > 0; --count, ++i) {
      if ((byte(i) & 0xC0U) != 0x80U) return false;
    }
    return true;
  };
  std::size_t i = 0;
  while (i < text.size()) {
    const std::uint8_t first = byte(i), second = byte(i + 1);
    if (first < 0x80) {
      i += 1;
    } else if (first >= 0xC2 && first <= 0xDF && follows(i + 1, 1)) {
      i += 2;
    } else if ((first & 0xF0U) == 0xE0 && follows(i + 1, 2) && (first != 0xE0 || second >= 0xA0) &&
               (first != 0xED || second <= 0x9F)) {
      i += 3;
    } else if (first >= 0xF0 && first <= 0xF4 && follows(i + 1, 3) && (first != 0xF0 || second >= 0x90) &&
               (first != 0xF4 || second <= 0x8F)) {
      i += 4;
    } else {
      return i;
    }
  }
  return text.size();
}

/// The number of the line, from 1, that a place in a text is in.
inline std::ptrdiff_t line_of(std::string_view text, std::size_t place) {
  return 1 + std::ranges::count(text.substr(0, place), '\n');
}

}  // namespace example

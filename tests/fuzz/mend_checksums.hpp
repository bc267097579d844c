// Files end in a checksum that random bytes never meet. What comes behind it is reached by bytes whose checksums were
// made right.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "surefoot/core/binary.hpp"
#include "surefoot/forest/serialize.hpp"
#include "tests/fuzz/feeds.hpp"

namespace fuzz {

inline surefoot::Bytes as_bytes(Input input) {
  const auto bytes = std::as_bytes(input);
  return {bytes.begin(), bytes.end()};
}

namespace detail {

inline void put(surefoot::Bytes& bytes, std::size_t at, std::uint64_t number) {
  surefoot::ByteWriter writer;
  writer.u64(number);
  std::ranges::copy(writer.bytes(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

// Of the forest that begins at `start`, if its header says where its checksum is.
inline void mend_forest(surefoot::Bytes& bytes, std::size_t start) {
  const auto from_start = std::span<const std::byte>(bytes).subspan(start);
  surefoot::ByteReader in(from_start, "forest");
  std::size_t size = 0;
  try {
    size = surefoot::detail::stored_bytes(in);
  } catch (const surefoot::CoreError&) {
    return;
  }
  if (size <= from_start.size()) put(bytes, start + size - 8, surefoot::checksum(from_start.first(size - 8)));
}

}  // namespace detail

/// With right checksums of every forest inside and of the whole file.
inline surefoot::Bytes with_checksums(surefoot::Bytes bytes) {
  const auto magic = std::as_bytes(std::span(std::string_view("SUREFRST")));
  for (auto at = bytes.begin(); at != bytes.end(); ++at) {
    at = std::search(at, bytes.end(), magic.begin(), magic.end());
    if (at == bytes.end()) break;
    detail::mend_forest(bytes, static_cast<std::size_t>(at - bytes.begin()));
  }
  if (bytes.size() >= 8) {
    const std::size_t end = bytes.size() - 8;
    detail::put(bytes, end, surefoot::checksum(std::span<const std::byte>(bytes).first(end)));
  }
  return bytes;
}

/// The bytes as they are, and with right checksums.
inline std::array<surefoot::Bytes, 2> both_ways(Input input) {
  return {as_bytes(input), with_checksums(as_bytes(input))};
}

}  // namespace fuzz

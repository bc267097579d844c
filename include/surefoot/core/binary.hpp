// Binary files: little-endian on every machine, bounds-checked, and never left half written.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"

namespace surefoot {

using Bytes = std::vector<std::byte>;

namespace detail {

// To little-endian or back.
template <std::unsigned_integral T>
constexpr T little(T value) {
  if constexpr (std::endian::native == std::endian::little) {
    return value;
  } else {
    T swapped = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) swapped = static_cast<T>((swapped << 8) | ((value >> (8 * i)) & 0xFF));
    return swapped;
  }
}

template <std::size_t Size>
struct WordOf;
template <>
struct WordOf<1> {
  using type = std::uint8_t;
};
template <>
struct WordOf<4> {
  using type = std::uint32_t;
};
template <>
struct WordOf<8> {
  using type = std::uint64_t;
};

}  // namespace detail

/// A number (or a struct that is nothing but one, like a node of a tree) of 1, 4 or 8 bytes.
template <class T>
concept Word = std::is_trivially_copyable_v<T> && requires {
  typename detail::WordOf<sizeof(T)>::type;
};

/// A checksum of 64 bits. A change within one aligned group of 8 bytes is always noticed, any other with probability
/// 1 - 2^-64. About 6 GB/s.
std::uint64_t checksum(std::span<const std::byte> bytes);

/// Appends numbers to a growing array of bytes.
class ByteWriter {
 public:
  void u8(std::uint8_t value) { word(value); }
  void u32(std::uint32_t value) { word(value); }
  void u64(std::uint64_t value) { word(value); }
  void f32(float value) { word(value); }
  void f64(double value) { word(value); }
  void raw(std::span<const std::byte> bytes);

  /// The items alone; the reader must know how many there are.
  template <Word T>
  void words(std::span<const T> items) {
    if constexpr (std::endian::native == std::endian::little) {
      raw(std::as_bytes(items));
    } else {
      for (const T& item : items) word(item);
    }
  }

  /// The number of items, then the items: for ByteReader::list.
  template <Word T>
  void list(std::span<const T> items) {
    u64(items.size());
    words(items);
  }
  template <Word T>
  void list(const std::vector<T>& items) {
    list(std::span<const T>(items));
  }

  /// Length and characters: for ByteReader::text.
  void text(std::string_view characters) { list(std::span<const char>(characters)); }

  /// The checksum of everything from byte `start` on: for ByteReader::expect_checksum.
  void add_checksum(std::size_t start = 0) { u64(checksum(std::span(bytes_).subspan(start))); }

  std::size_t size() const { return bytes_.size(); }
  const Bytes& bytes() const& { return bytes_; }
  Bytes bytes() && { return std::move(bytes_); }

 private:
  template <Word T>
  void word(const T& value) {
    const auto bits = detail::little(std::bit_cast<typename detail::WordOf<sizeof(T)>::type>(value));
    raw(std::as_bytes(std::span(&bits, 1)));
  }

  Bytes bytes_;
};

/// Takes numbers out of bytes again. Reading past the end throws a CoreError that names the source; no size that was
/// read is trusted before as many bytes are known to be there.
class ByteReader {
 public:
  /// `bytes` must outlive the reader; `source` names them in messages ("file x.bin").
  ByteReader(std::span<const std::byte> bytes, std::string source) : bytes_(bytes), source_(std::move(source)) {}

  std::uint8_t u8() { return word<std::uint8_t>(); }
  std::uint32_t u32() { return word<std::uint32_t>(); }
  std::uint64_t u64() { return word<std::uint64_t>(); }
  float f32() { return word<float>(); }
  double f64() { return word<double>(); }

  std::span<const std::byte> raw(std::size_t count) {
    need(count, 1);
    position_ += count;
    return bytes_.subspan(position_ - count, count);
  }

  /// Fills `items`, any vector of words.
  template <class Vector>
  void words(Vector& items, std::size_t count) {
    using T = typename Vector::value_type;
    static_assert(Word<T>);
    need(count, sizeof(T));
    items.resize(count);
    if constexpr (std::endian::native == std::endian::little) {
      const auto from = raw(count * sizeof(T));
      if (count != 0) std::memcpy(items.data(), from.data(), from.size());
    } else {
      for (T& item : items) item = word<T>();
    }
  }

  template <Word T>
  std::vector<T> list() {
    std::vector<T> items;
    words(items, count());
    return items;
  }

  std::string text() {
    std::string characters;
    words(characters, count());
    return characters;
  }

  /// Throws unless the next 8 bytes are the checksum of everything from byte `start` up to here.
  void expect_checksum(std::size_t start = 0);

  /// Throws unless everything was read.
  void expect_end() const;

  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }
  const std::string& source() const { return source_; }

  [[noreturn]] void fail(const std::string& what) const;

 private:
  void need(std::uint64_t count, std::size_t size) const {
    if (count > remaining() / size) fail_at_end(count, size);
  }
  [[noreturn]] void fail_at_end(std::uint64_t count, std::size_t size) const;

  std::size_t count() {
    const std::uint64_t count = u64();
    need(count, 1);
    return static_cast<std::size_t>(count);
  }

  template <Word T>
  T word() {
    typename detail::WordOf<sizeof(T)>::type bits{};
    std::memcpy(&bits, raw(sizeof(T)).data(), sizeof(T));
    return std::bit_cast<T>(detail::little(bits));
  }

  std::span<const std::byte> bytes_;
  std::string source_;
  std::size_t position_ = 0;
};

/// What a file starts with: characters that tell its kind, and the version of its format.
struct FileFormat {
  std::string_view magic;
  std::uint32_t version = 1;
  std::string_view kind;  // for messages: "a forest"
};

void write_format(ByteWriter& out, const FileFormat& format);

/// Throws a CoreError unless the next bytes are those of write_format().
void expect_format(ByteReader& in, const FileFormat& format);

/// Whether it starts so; `in` stays where it is.
bool has_format(ByteReader in, const FileFormat& format);

/// Writes the file aside (path + ".part"), flushes it to the disk and renames it, so that `path` holds the old bytes or
/// the new ones, never half, whether the program dies or the power goes. Waits for the disk, some milliseconds.
void write_file_atomically(const std::string& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::string& path, std::string_view text);

bool file_exists(const std::string& path);

/// All bytes of a file.
Bytes read_file(const std::string& path);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/core/binary.ipp"
#endif

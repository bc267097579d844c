// Definitions of surefoot/core/binary.hpp.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <system_error>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#else
#include <filesystem>
#endif

namespace surefoot {

SUREFOOT_INLINE void ByteWriter::raw(std::span<const std::byte> bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

SUREFOOT_INLINE std::uint64_t checksum(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0x9E3779B97F4A7C15U + bytes.size();
  auto absorb = [&hash](std::uint64_t word) {  // one-to-one in `hash` and in `word`
    hash = (hash ^ word) * 0xD6E8FEB86659FD93U;
    hash ^= hash >> 32;
  };
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), 8);
    absorb(detail::little(word));
  }
  std::uint64_t word = 0;
  if (!bytes.empty()) std::memcpy(&word, bytes.data(), bytes.size());
  absorb(detail::little(word));
  return hash;
}

SUREFOOT_ONCE void ByteReader::fail(const std::string& what) const { throw CoreError(source_ + " " + what); }

SUREFOOT_ONCE void ByteReader::fail_at_end(std::uint64_t count, std::size_t size) const {
  fail("ends too early: " + std::to_string(count) + " items of " + std::to_string(size) + " bytes expected at byte " +
       std::to_string(position_) + ", but only " + std::to_string(remaining()) + " bytes follow");
}

SUREFOOT_ONCE void ByteReader::expect_checksum(std::size_t start) {
  const std::uint64_t expected = checksum(bytes_.subspan(start, position_ - start));
  if (u64() != expected) fail("is damaged: its checksum does not match");
}

SUREFOOT_ONCE void ByteReader::expect_end() const {
  if (remaining() != 0) fail("has " + std::to_string(remaining()) + " bytes more than expected");
}

SUREFOOT_ONCE void write_format(ByteWriter& out, const FileFormat& format) {
  out.raw(std::as_bytes(std::span(format.magic)));
  out.u32(format.version);
}

SUREFOOT_ONCE bool has_format(ByteReader in, const FileFormat& format) {
  if (in.remaining() < format.magic.size() + 4) return false;
  const auto magic = in.raw(format.magic.size());
  return std::memcmp(magic.data(), format.magic.data(), magic.size()) == 0 && in.u32() == format.version;
}

SUREFOOT_ONCE void expect_format(ByteReader& in, const FileFormat& format) {
  const auto magic = in.raw(format.magic.size());
  if (std::memcmp(magic.data(), format.magic.data(), magic.size()) != 0) {
    in.fail("is not " + std::string(format.kind) + ": it must start with \"" + std::string(format.magic) + "\"");
  }
  if (const std::uint32_t version = in.u32(); version != format.version) {
    in.fail("has format version " + std::to_string(version) + ", this library reads version " +
            std::to_string(format.version));
  }
}

namespace detail {

enum class PathKind { missing, file, folder, other };

#if defined(__unix__) || defined(__APPLE__)

SUREFOOT_ONCE PathKind path_kind(const std::string& path) {
  struct ::stat status = {};
  if (::stat(path.c_str(), &status) != 0) return PathKind::missing;
  return S_ISREG(status.st_mode) ? PathKind::file : S_ISDIR(status.st_mode) ? PathKind::folder : PathKind::other;
}

/// Waits until the bytes of a file are on the disk, not only on their way there.
SUREFOOT_ONCE std::error_code flush_to_disk(const std::string& path) {
  std::error_code error;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool flushed = file >= 0 && (::fsync(file) == 0 || errno == EINVAL);  // EINVAL: no disk behind it
  if (!flushed) error.assign(errno, std::generic_category());
  if (file >= 0) ::close(file);
  return error;
}

SUREFOOT_ONCE std::error_code rename_file(const std::string& from, const std::string& to) {
  std::error_code error;
  if (std::rename(from.c_str(), to.c_str()) != 0) error.assign(errno, std::generic_category());
  return error;
}

#else

SUREFOOT_ONCE PathKind path_kind(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return PathKind::missing;
  return std::filesystem::is_regular_file(status) ? PathKind::file
         : std::filesystem::is_directory(status)  ? PathKind::folder
                                                  : PathKind::other;
}

SUREFOOT_ONCE std::error_code flush_to_disk(const std::string&) { return {}; }

SUREFOOT_ONCE std::error_code rename_file(const std::string& from, const std::string& to) {
  std::error_code error;
  std::filesystem::rename(from, to, error);
  return error;
}

#endif

}  // namespace detail

SUREFOOT_ONCE void write_file_atomically(const std::string& path, std::span<const std::byte> bytes) {
  const std::string aside = path + ".part";
  const detail::PathKind old = detail::path_kind(path);
  if (old == detail::PathKind::folder || old == detail::PathKind::other) {  // the rename would take its place
    throw CoreError("file " + path + " is a folder or a device: give the name of a plain file");
  }
  std::error_code error;
  if (std::FILE* file = std::fopen(aside.c_str(), "wb"); file != nullptr) {
    const bool written = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (std::fclose(file) == 0 && written) {
      error = detail::flush_to_disk(aside);
      if (!error) error = detail::rename_file(aside, path);
      if (!error) return;
    }
  }
  std::remove(aside.c_str());
  throw CoreError("file " + path + " cannot be written: check that its folder exists, is writable and has space" +
                  (error ? " (" + error.message() + ")" : ""));
}

SUREFOOT_ONCE void write_file_atomically(const std::string& path, std::string_view text) {
  write_file_atomically(path, std::as_bytes(std::span(text)));
}

SUREFOOT_ONCE bool file_exists(const std::string& path) {
  return detail::path_kind(path) != detail::PathKind::missing;
}

SUREFOOT_ONCE Bytes read_file(const std::string& path) {
  if (detail::path_kind(path) == detail::PathKind::folder) throw CoreError("file " + path + " is a folder");
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  const long size = file && std::fseek(file.get(), 0, SEEK_END) == 0 ? std::ftell(file.get()) : -1;
  if (size < 0) throw CoreError("file " + path + " cannot be opened: check its name and permissions");
  Bytes bytes(static_cast<std::size_t>(size));
  std::rewind(file.get());
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
    throw CoreError("file " + path + " cannot be read to its end");
  return bytes;
}

}  // namespace surefoot

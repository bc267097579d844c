#include "surefoot/core/binary.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace surefoot {
namespace {

struct Folder {  // a scratch folder of this test, removed at its end
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("surefoot_binary_test_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
};

Bytes bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

Bytes sample() {
  ByteWriter writer;
  writer.u8(7);
  writer.u32(0x01020304);
  writer.u64(0x0102030405060708);
  writer.f32(-0.5F);
  writer.f64(std::numeric_limits<double>::denorm_min());
  writer.text("surefoot");
  writer.list(std::vector<double>{1, -2, 3});
  writer.list(std::vector<std::uint32_t>{});
  writer.add_checksum();
  return std::move(writer).bytes();
}

// Everything sample() wrote; throws where the bytes do not allow it.
void read_sample(const Bytes& bytes) {
  ByteReader reader(bytes, "sample");
  reader.u8();
  reader.u32();
  reader.u64();
  reader.f32();
  reader.f64();
  reader.text();
  reader.list<double>();
  reader.list<std::uint32_t>();
  reader.expect_checksum();
  reader.expect_end();
}

TEST_CASE("what was written is read back") {
  const Bytes bytes = sample();
  ByteReader reader(bytes, "sample");
  CHECK(reader.u8() == 7);
  CHECK(reader.u32() == 0x01020304);
  CHECK(reader.u64() == 0x0102030405060708);
  CHECK(reader.f32() == -0.5F);
  CHECK(reader.f64() == std::numeric_limits<double>::denorm_min());
  CHECK(reader.text() == "surefoot");
  CHECK(reader.list<double>() == std::vector<double>{1, -2, 3});
  CHECK(reader.list<std::uint32_t>().empty());
  reader.expect_checksum();
  reader.expect_end();
  CHECK(reader.position() == bytes.size());
}

TEST_CASE("numbers are stored with the lowest byte first") {
  ByteWriter writer;
  writer.u32(0x01020304);
  CHECK(writer.bytes() == Bytes{std::byte{4}, std::byte{3}, std::byte{2}, std::byte{1}});
}

TEST_CASE("a file cut short anywhere is refused with its name") {
  const Bytes bytes = sample();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Bytes part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    CAPTURE(size);
    CHECK_THROWS_WITH_AS(read_sample(part), doctest::Contains("sample"), CoreError);
  }
}

TEST_CASE("every single bit flip is noticed") {
  const Bytes bytes = sample();
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Bytes flipped = bytes;
    flipped[bit / 8] ^= std::byte{1} << (bit % 8);
    CAPTURE(bit);
    CHECK_THROWS_AS(read_sample(flipped), CoreError);
  }
}

TEST_CASE("appended bytes are noticed") {
  Bytes bytes = sample();
  bytes.push_back(std::byte{0});
  CHECK_THROWS_WITH_AS(read_sample(bytes), doctest::Contains("1 bytes more"), CoreError);
}

TEST_CASE("a length that cannot be true is refused before memory is asked for") {
  for (const std::uint64_t length : {std::uint64_t{2}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    ByteWriter writer;
    writer.u64(length);
    writer.f64(1);
    ByteReader list(writer.bytes(), "file");
    CHECK_THROWS_AS(list.list<double>(), CoreError);
    ByteReader raw(writer.bytes(), "file");
    raw.u64();
    CHECK_THROWS_AS(raw.raw(std::max<std::uint64_t>(length, 9)), CoreError);
  }
}

TEST_CASE("the checksum depends on every byte, their order and their number") {
  CHECK(checksum(bytes_of("abcdefgh12")) != checksum(bytes_of("abcdefgh21")));
  CHECK(checksum(bytes_of("abcdefgh12345678")) != checksum(bytes_of("12345678abcdefgh")));
  CHECK(checksum(Bytes(3)) != checksum(Bytes(4)));
  CHECK(checksum(Bytes(8)) != checksum(Bytes(16)));
  CHECK(checksum({}) == checksum(Bytes{}));
}

TEST_CASE("a file is written whole, over an older one, and nothing else is left behind") {
  const Folder folder;
  const auto path = folder.path / "file.bin";
  write_file_atomically(path, sample());
  CHECK(read_file(path) == sample());
  write_file_atomically(path, "short");
  CHECK(read_file(path) == bytes_of("short"));
  write_file_atomically(path, "");
  CHECK(read_file(path).empty());
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("a file that cannot be written or read is named") {
  const Folder folder;
  CHECK_THROWS_WITH_AS(write_file_atomically(folder.path / "none" / "file.bin", "x"), doctest::Contains("file.bin"),
                       CoreError);
  CHECK_THROWS_WITH_AS(read_file(folder.path / "missing.bin"), doctest::Contains("missing.bin"), CoreError);
  CHECK_THROWS_WITH_AS(read_file(folder.path), doctest::Contains("is a folder"), CoreError);
}

TEST_CASE("a path that cannot be replaced keeps what it holds, and the aside file goes") {
  const Folder folder;
  const auto path = folder.path / "occupied";
  std::filesystem::create_directories(path / "inside");
  CHECK_THROWS_AS(write_file_atomically(path, "x"), CoreError);
  CHECK(std::filesystem::exists(path / "inside"));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 1);
}

}  // namespace
}  // namespace surefoot

// The worked examples of the ROBOTIS e-Manual, page "DYNAMIXEL Protocol 1.0", byte for byte.
#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

#include "examples/sigmaban/robot/dynamixel/protocol1.hpp"
#include "tests/examples/robot_dynamixel_hex.hpp"

using namespace dynamixel;
using namespace dynamixel::protocol1;

namespace {

std::array<std::uint8_t, max_packet_size> buffer;

std::string sent(Bytes packet) { return hex_of(packet); }

/// The one status packet in there: id, errors, data.
std::string received(const std::string& hex) {
  Decoder<> decoder;
  std::string text;
  decoder.decode(bytes_of(hex), [&](const Packet& packet) {
    const auto status = as_status(packet);
    REQUIRE(status);
    text += "id " + std::to_string(status->id) + " errors " + std::to_string(status->errors) + ": " +
            hex_of(status->data) + ";";
  });
  return text;
}

}  // namespace

TEST_CASE("Protocol 1.0: instruction packets of the e-Manual") {
  // Instruction Packet, Instruction Checksum
  CHECK(sent(write(buffer, 1, 0x0C, bytes_of("64 AA"))) == "FF FF 01 05 03 0C 64 AA DC");
  // Instruction Details: Ping, Read, Write, Reg Write, Action, Factory Reset, Sync Write, Bulk Read
  CHECK(sent(ping(buffer, 1)) == "FF FF 01 02 01 FB");
  CHECK(sent(read(buffer, 1, 43, 1)) == "FF FF 01 04 02 2B 01 CC");
  CHECK(sent(write(buffer, broadcast_id, 3, bytes_of("01"))) == "FF FF FE 04 03 03 01 F6");
  CHECK(sent(reg_write(buffer, 1, 30, bytes_of("F4 01"))) == "FF FF 01 05 04 1E F4 01 E2");
  CHECK(sent(action(buffer)) == "FF FF FE 02 05 FA");
  CHECK(sent(factory_reset(buffer, 0)) == "FF FF 00 02 06 F7");
  CHECK(sent(sync_write(buffer, 30, 4, bytes_of("00 01"), bytes_of("10 00 50 01 20 02 60 03"))) ==
        "FF FF FE 0E 83 1E 04 00 10 00 50 01 01 20 02 60 03 67");
  CHECK(sent(bulk_read(buffer, std::array{BulkItem{1, 30, 2}, BulkItem{2, 36, 2}})) ==
        "FF FF FE 09 92 00 02 01 1E 02 02 24 1D");
}

TEST_CASE("Protocol 1.0: status packets of the e-Manual") {
  // Status Packet, Error: overload and overheating
  CHECK(received("FF FF 01 02 24 D8") == "id 1 errors " + std::to_string(overload_error | overheating_error) + ": ;");
  CHECK(sent(status(buffer, 1, overload_error | overheating_error)) == "FF FF 01 02 24 D8");
  // Instruction Details: Ping and Reg Write, Read, Factory Reset, Bulk Read
  CHECK(received("FF FF 01 02 00 FC") == "id 1 errors 0: ;");
  CHECK(received("FF FF 01 03 00 20 DB") == "id 1 errors 0: 20;");
  CHECK(sent(status(buffer, 1, 0, bytes_of("20"))) == "FF FF 01 03 00 20 DB");
  CHECK(received("FF FF 00 02 00 FD") == "id 0 errors 0: ;");
  CHECK(received("FF FF 01 04 00 00 80 7A FF FF 02 04 00 00 80 79") == "id 1 errors 0: 00 80;id 2 errors 0: 00 80;");
}

TEST_CASE("Protocol 1.0: what cannot be sent is no packet") {
  CHECK(ping(buffer, 0xFF).empty());
  CHECK(status(buffer, broadcast_id, 0).empty());
  CHECK(read(buffer, 1, 256, 1).empty());
  CHECK(read(buffer, 1, 0, 256).empty());
  CHECK(ping(Buffer(buffer).first(5), 1).empty());
  CHECK_FALSE(ping(Buffer(buffer).first(6), 1).empty());
  CHECK(ping({}, 1).empty());
  CHECK(sync_write(buffer, 30, 2, bytes_of("01 02"), bytes_of("01 02 03")).empty());
  CHECK(sync_write(buffer, 30, 1, bytes_of("FE"), bytes_of("01")).empty());
  const std::vector<std::uint8_t> data(254);
  CHECK(encode(buffer, 1, Instruction::write, Bytes(data).first(253)).size() == max_packet_size);
  CHECK(encode(buffer, 1, Instruction::write, data).empty());
  std::array<std::uint8_t, 1000> large;
  CHECK(encode(large, 1, Instruction::write, data).empty());
}

TEST_CASE("Protocol 1.0: a third FF before the id belongs to no packet") {
  CHECK(received("FF FF FF FF 01 02 00 FC") == "id 1 errors 0: ;");
}

// The worked examples of the ROBOTIS e-Manual, page "DYNAMIXEL Protocol 2.0", byte for byte.
#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

#include "examples/sigmaban/robot/dynamixel/protocol2.hpp"
#include "tests/examples/robot_dynamixel_hex.hpp"

using namespace dynamixel;
using namespace dynamixel::protocol2;

namespace {

std::array<std::uint8_t, 1024> buffer;

std::string sent(Bytes packet) { return hex_of(packet); }

/// The status packets in there: id, error, data.
std::string received(const std::string& hex) {
  Decoder<> decoder;
  std::string text;
  decoder.decode(bytes_of(hex), [&](const Packet& packet) {
    const auto status = as_status(packet);
    REQUIRE(status);
    text += "id " + std::to_string(status->id) + " error " + std::to_string(static_cast<int>(status->error)) +
            (status->alert ? " alert" : "") + ": " + hex_of(status->data) + ";";
  });
  return text;
}

}  // namespace

TEST_CASE("the CRC has its published check value") {
  CHECK(crc16(bytes_of("31 32 33 34 35 36 37 38 39")) == 0xFEE8);  // CRC-16/BUYPASS of "123456789"
  CHECK(crc16({}) == 0);
}

TEST_CASE("Protocol 2.0: instruction packets of the e-Manual") {
  // Instruction Details: Ping (examples 1 and 2), Read, Write, Reg Write, Action, Factory Reset, Reboot, Clear
  CHECK(sent(ping(buffer, 1)) == "FF FF FD 00 01 03 00 01 19 4E");
  CHECK(sent(ping(buffer, broadcast_id)) == "FF FF FD 00 FE 03 00 01 31 42");
  CHECK(sent(read(buffer, 1, 132, 4)) == "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15");
  CHECK(sent(write(buffer, 1, 116, bytes_of("00 02 00 00"))) == "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89");
  CHECK(sent(reg_write(buffer, 1, 104, bytes_of("C8 00 00 00"))) == "FF FF FD 00 01 09 00 04 68 00 C8 00 00 00 AE 8E");
  CHECK(sent(action(buffer, 1)) == "FF FF FD 00 01 03 00 05 02 CE");
  CHECK(sent(factory_reset(buffer, 1, ResetOption::all_but_id)) == "FF FF FD 00 01 04 00 06 01 A1 E6");
  CHECK(sent(reboot(buffer, 1)) == "FF FF FD 00 01 03 00 08 2F 4E");
  CHECK(sent(clear_turns(buffer, 1)) == "FF FF FD 00 01 08 00 10 01 44 58 4C 22 B1 DC");
  // Sync Read, Sync Write, Bulk Read, Bulk Write
  CHECK(sent(sync_read(buffer, 132, 4, bytes_of("01 02"))) == "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA");
  CHECK(sent(sync_write(buffer, 116, 4, bytes_of("01 02"), bytes_of("96 00 00 00 AA 00 00 00"))) ==
        "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87");
  CHECK(sent(bulk_read(buffer, std::array{BulkItem{1, 144, 2}, BulkItem{2, 146, 1}})) ==
        "FF FF FD 00 FE 0D 00 92 01 90 00 02 00 02 92 00 01 00 1A 05");
  CHECK(sent(bulk_write(buffer, std::array{BulkItem{1, 32, 2}, BulkItem{2, 31, 1}}, bytes_of("A0 00 50"))) ==
        "FF FF FD 00 FE 10 00 93 01 20 00 02 00 A0 00 02 1F 00 01 00 50 B7 68");
}

TEST_CASE("Protocol 2.0: status packets of the e-Manual") {
  // Ping, Read, Write (and Reg Write, Action, Factory Reset, Reboot, Clear), Sync Read, Bulk Read
  CHECK(received("FF FF FD 00 01 07 00 55 00 06 04 26 65 5D FF FF FD 00 02 07 00 55 00 06 04 26 6F 6D") ==
        "id 1 error 0: 06 04 26;id 2 error 0: 06 04 26;");
  CHECK(received("FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0") == "id 1 error 0: A6 00 00 00;");
  CHECK(received("FF FF FD 00 01 04 00 55 00 A1 0C") == "id 1 error 0: ;");
  CHECK(received("FF FF FD 00 02 08 00 55 00 1F 08 00 00 BA BE") == "id 2 error 0: 1F 08 00 00;");
  CHECK(received("FF FF FD 00 01 06 00 55 00 77 00 C3 69 FF FF FD 00 02 05 00 55 00 24 8B A9") ==
        "id 1 error 0: 77 00;id 2 error 0: 24;");
  CHECK(sent(status(buffer, 1, Error::none, false, bytes_of("A6 00 00 00"))) ==
        "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0");
  CHECK(sent(status(buffer, 2, Error::none, false, bytes_of("24"))) == "FF FF FD 00 02 05 00 55 00 24 8B A9");
  CHECK(received(sent(status(buffer, 7, Error::data_range, true))) == "id 7 error 4 alert: ;");
}

TEST_CASE("Protocol 2.0: FF FF FD inside a packet is stuffed, and the stuffing taken out again") {
  for (const char* data : {"FF FF FD", "FF FF FD FD", "FF FF FF FD", "FF FF FD FF FF FD", "00 FF FF FD 00 01",
                           "FD FF FF", "FF FF FD FD FD FD", "FF FF FD 00 01 03 00 01 19 4E"}) {
    CAPTURE(data);
    const std::string packet = sent(write(buffer, 1, 116, bytes_of(data)));
    Decoder<> decoder;
    int count = 0;
    decoder.decode(bytes_of(packet), [&](const Packet& p) {
      ++count;
      CHECK(hex_of(p.parameters) == std::string("74 00 ") + data);
    });
    CHECK(count == 1);
  }
  // Packet Process, Processing Order of Transmission: the length is that with stuffing
  CHECK(sent(write(buffer, 1, 116, bytes_of("FF FF FD"))).substr(0, 41) == "FF FF FD 00 01 09 00 03 74 00 FF FF FD FD");
  // the pattern also counts across the instruction's parameters, whatever they mean
  CHECK(sent(write(buffer, 1, 0xFFFF, bytes_of("FD"))).substr(21, 14) == "03 FF FF FD FD");
}

TEST_CASE("Protocol 2.0: a packet whose stuffing is missing is refused") {
  std::vector<std::uint8_t> bytes = bytes_of("FF FF FD 00 01 08 00 03 74 00 FF FF FD");
  const std::uint16_t crc = crc16(bytes);
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  Decoder<> decoder;
  decoder.decode(bytes, [](const Packet&) { FAIL("accepted"); });
}

TEST_CASE("Protocol 2.0: what cannot be sent is no packet") {
  CHECK(ping(buffer, 0xFD).empty());
  CHECK(ping(buffer, 0xFF).empty());
  CHECK(status(buffer, broadcast_id, Error::none).empty());
  CHECK(ping(Buffer(buffer).first(9), 1).empty());
  CHECK_FALSE(ping(Buffer(buffer).first(10), 1).empty());
  CHECK(ping({}, 1).empty());
  CHECK(sync_write(buffer, 116, 4, bytes_of("01 02"), bytes_of("01 02 03 04")).empty());
  CHECK(sync_write(buffer, 116, 0, bytes_of("01 02"), {}).empty());
  CHECK(sync_read(buffer, 116, 4, bytes_of("FE")).empty());
  CHECK(bulk_write(buffer, std::array{BulkItem{1, 32, 2}}, bytes_of("01")).empty());
  CHECK(bulk_write(buffer, std::array{BulkItem{1, 32, 2}}, bytes_of("01 02 03")).empty());
  std::vector<std::uint8_t> large(70'000), data(65'533);
  CHECK(encode(large, 1, Instruction::write, Bytes(data).first(65'532)).size() == max_packet_size);
  CHECK(encode(large, 1, Instruction::write, data).empty());
}

TEST_CASE("Protocol 2.0: an instruction is no status") {
  CHECK_FALSE(as_status(Packet{1, static_cast<std::uint8_t>(Instruction::ping), {}}));
  CHECK_FALSE(as_status(Packet{1, static_cast<std::uint8_t>(Instruction::status), {}}));
}

// Packets that a decoder accepts must be, encoded again, the bytes they came from.
#include <algorithm>
#include <array>

#include "examples/sigmaban/robot/dynamixel/protocol1.hpp"
#include "examples/sigmaban/robot/dynamixel/protocol2.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"

namespace {

template <class Decoder, class Encode>
void feed(dynamixel::Bytes bytes, Encode encode) {
  Decoder decoder;
  std::array<std::uint8_t, 4096> again;
  const auto check = [&](const dynamixel::Packet& packet) {
    const dynamixel::Bytes whole = encode(dynamixel::Buffer(again), packet);
    fuzz::require(!whole.empty(), "a packet that cannot be sent again");
    fuzz::require(std::search(bytes.begin(), bytes.end(), whole.begin(), whole.end()) != bytes.end(),
                  "a packet that was not there");
  };
  decoder.decode(bytes, check);
  while (decoder.pending() > 0) {
    decoder.give_up();
    while (const auto packet = decoder.next()) check(*packet);
  }
}

}  // namespace

void fuzz::dynamixel(Input input) {
  using namespace ::dynamixel;
  const Bytes bytes(input);
  feed<protocol1::Decoder<>>(
      bytes, [](Buffer out, const Packet& p) { return protocol1::encode(out, p.id, p.code, p.parameters); });
  feed<protocol2::Decoder<>>(bytes, [](Buffer out, const Packet& p) {
    return protocol2::encode(out, p.id, static_cast<Instruction>(p.code), p.parameters);
  });
}

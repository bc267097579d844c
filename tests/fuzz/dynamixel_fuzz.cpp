// Feeds any bytes to the decoders of both Dynamixel protocols. Built with a clang that has its fuzzer runtime (package
// libclang-rt-<version>-dev), only where it is asked for:
//
//   cmake -S . -B build/fuzz -D CMAKE_CXX_COMPILER=clang++ -D SUREFOOT_FUZZ=ON
//   cmake --build build/fuzz --target dynamixel_fuzz && build/fuzz/bin/dynamixel_fuzz -max_len=4096
//
// What is accepted must be, encoded again, the bytes it came from.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "examples/sigmaban_robot/dynamixel/protocol1.hpp"
#include "examples/sigmaban_robot/dynamixel/protocol2.hpp"

namespace {

template <class Decoder, class Encode>
void feed(dynamixel::Bytes bytes, Encode encode) {
  Decoder decoder;
  std::array<std::uint8_t, 4096> again;
  const auto check = [&](const dynamixel::Packet& packet) {
    const dynamixel::Bytes whole = encode(dynamixel::Buffer(again), packet);
    if (whole.empty()) std::abort();
    if (std::search(bytes.begin(), bytes.end(), whole.begin(), whole.end()) == bytes.end()) std::abort();
  };
  decoder.decode(bytes, check);
  while (decoder.pending() > 0) {
    decoder.give_up();
    while (const auto packet = decoder.next()) check(*packet);
  }
}

}  // namespace

// The name is libFuzzer's. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamixel;
  const Bytes bytes(data, size);
  feed<protocol1::Decoder<>>(
      bytes, [](Buffer out, const Packet& p) { return protocol1::encode(out, p.id, p.code, p.parameters); });
  feed<protocol2::Decoder<>>(bytes, [](Buffer out, const Packet& p) {
    return protocol2::encode(out, p.id, static_cast<Instruction>(p.code), p.parameters);
  });
  return 0;
}

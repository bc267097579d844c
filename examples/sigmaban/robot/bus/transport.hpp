// How a bus reaches its servos: bytes out, bytes in, and a clock.
#pragma once

#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "../dynamixel/packet.hpp"
#include "surefoot/core/error.hpp"

namespace dynamixel {

/// A moment, since any fixed one, or a duration. Clocks never go back.
using Time = std::chrono::nanoseconds;

constexpr Time from_seconds(double seconds) { return Time(static_cast<std::int64_t>(seconds * 1e9)); }
constexpr double to_seconds(Time time) { return static_cast<double>(time.count()) * 1e-9; }

/// A port that cannot be opened or used, or arguments no packet can carry; the message names it and the cure.
struct BusError : surefoot::Error {
  using Error::Error;
};

/// `write` hands over all bytes or throws BusError at the deadline; it need not wait until they are on the line. `read`
/// returns as soon as there is a byte, with all there are; 0 at the deadline. Bytes there already are read even where
/// the deadline has passed.
///
///   struct Smallest {
///     Time now();
///     std::uint32_t bits_per_s();
///     void write(Bytes, Time deadline);
///     std::size_t read(Buffer, Time deadline);
///   };
template <class T>
concept Transport = requires(T& transport, Bytes out, Buffer in, Time deadline) {
  { transport.now() } -> std::same_as<Time>;
  { transport.bits_per_s() } -> std::convertible_to<std::uint32_t>;
  transport.write(out, deadline);
  { transport.read(in, deadline) } -> std::same_as<std::size_t>;
};

/// What `count` bytes take on the line: a start bit, eight bits and a stop bit each.
constexpr Time line_time(std::size_t count, std::uint32_t bits_per_s) {
  return Time(static_cast<std::int64_t>(count * 10'000'000'000ULL / bits_per_s));
}

}  // namespace dynamixel

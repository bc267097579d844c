// How asking a servo ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace dynamixel {

enum class Outcome : std::uint8_t {
  skipped,       // its turn did not come, or there was no time to ask
  answered,      // the one outcome with data
  refused,       // the servo did not do it, and said so
  lost,          // nothing came
  corrupted,     // bytes came, but no packet
  wrong_id,      // another's id came in its turn
  wrong_length,  // not as many bytes as asked for
};

constexpr std::string_view name_of(Outcome outcome) {
  constexpr std::string_view names[] = {"skipped",   "answered", "refused",     "lost",
                                        "corrupted", "wrong id", "wrong length"};
  return names[static_cast<std::size_t>(outcome)];
}

}  // namespace dynamixel

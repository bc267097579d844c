// What a reader may do with bytes: accept them, or throw an exception of its area with a message of one line.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include "surefoot/core/error.hpp"

namespace fuzz {

/// A reader did what none must do. No surefoot::Error, so that nothing takes it for a refusal.
struct Misbehaviour : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool good, const std::string& what) {
  if (!good) throw Misbehaviour(what);
}

constexpr std::size_t longest_message = 1000;  // characters; a path in it may be long, pieces of a file may not

inline void check_message(std::string_view message) {
  const bool one_line = message.find_first_of(std::string_view("\n\r\0", 3)) == std::string_view::npos;
  require(one_line && message.size() > 12 && message.size() <= longest_message,
          "a message that is no clear sentence: " + std::string(message.substr(0, 2 * longest_message)));
}

/// Runs job(); false if it refused with one of these exceptions. Others pass through, surefoot's as a Misbehaviour.
template <class... Refusals, class Job>
bool accepted(const Job& job) {
  try {
    job();
    return true;
  } catch (const surefoot::Error& error) {
    const bool expected = (... || (dynamic_cast<const Refusals*>(&error) != nullptr));
    require(expected, std::string("an exception of another area: ") + error.what());
    check_message(error.what());
    return false;
  }
}

}  // namespace fuzz

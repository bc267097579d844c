#pragma once

#include <string>

#include "tests/fuzz/feeds.hpp"

namespace fuzz {

inline std::string text_of(Input input) { return {input.begin(), input.end()}; }

}  // namespace fuzz

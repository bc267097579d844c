// Numbers and effects in words.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"

namespace surefoot {

/// Three significant digits.
std::string in_digits(double value);

inline std::string with_unit(double value, const std::string& unit) {
  return in_digits(value) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

/// Replaces "{name}" by the value of that parameter with its unit (and its 95 % interval, where that is wider than
/// half the value), and "{at}" by the place.
std::string fill_sentence(std::string sentence, const std::string& place, const std::vector<FittedValue>& values);

/// "a", "a and b", "a, b and c".
std::string in_list(const std::vector<std::string>& items);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/text.ipp"
#endif

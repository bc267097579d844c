// Definitions of surefoot/diagnose/text.hpp.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/text.hpp"

namespace surefoot {

SUREFOOT_ONCE std::string in_digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// "0.2 N m", and between which values it may be where that is much of it.
SUREFOOT_ONCE std::string with_doubt(const FittedValue& fitted) {
  constexpr double much = 0.5;  // of the value: the width of its 95 % interval that its digits hide
  const std::string text = with_unit(fitted.value, fitted.unit);
  if (!(fitted.high - fitted.low > much * std::abs(fitted.value))) return text;
  return text + " (" + in_digits(fitted.low) + " to " + in_digits(fitted.high) + ")";
}

SUREFOOT_ONCE std::string fill_sentence(std::string sentence, const std::string& place,
                                        const std::vector<FittedValue>& values) {
  const auto replace = [&sentence](const std::string& key, const std::string& text) {
    const std::string field = "{" + key + "}";
    for (std::size_t at = sentence.find(field); at != std::string::npos; at = sentence.find(field, at + text.size())) {
      sentence.replace(at, field.size(), text);
    }
  };
  replace("at", place);
  for (const FittedValue& value : values) replace(value.name, with_doubt(value));
  return sentence;
}

SUREFOOT_ONCE std::string in_list(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? " and " : ", ";
    text += items[i];
  }
  return text;
}

}  // namespace surefoot

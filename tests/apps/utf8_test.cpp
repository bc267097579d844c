#include "../../apps/common/utf8.hpp"

#include <doctest/doctest.h>

#include <string>
#include <string_view>

namespace example {
namespace {

using namespace std::string_view_literals;

TEST_CASE("characters of one to four bytes are UTF-8") {
  for (const std::string_view text :
       {""sv, "plain\n\0text"sv, "\u00b0"sv, "\u2264 \ud7ff \ue000 \uffff"sv, "\U00010000 \U0010ffff"sv}) {
    CHECK(first_not_utf8(text) == text.size());
  }
}

TEST_CASE("the first byte that is not is found") {
  for (const std::string_view wrong :
       {"\x80"sv,
        "\xB0"
        "C"sv,
        "\xC0\xAF"sv, "\xC1\xBF"sv, "\xC3"sv, "\xC3("sv, "\xE0\x80\x80"sv, "\xE2\x89"sv, "\xED\xA0\x80"sv,
        "\xF0\x80\x80\x80"sv, "\xF0\x90\x80"sv, "\xF4\x90\x80\x80"sv, "\xF5\x80\x80\x80"sv, "\xFF"sv}) {
    CHECK(first_not_utf8(wrong) == 0);
    CHECK(first_not_utf8("a\u00b0\n" + std::string(wrong) + "b") == 4);
  }
}

TEST_CASE("lines are counted from 1") {
  CHECK(line_of("a\nb\nc", 0) == 1);
  CHECK(line_of("a\nb\nc", 2) == 2);
  CHECK(line_of("a\nb\nc", 5) == 3);
}

}  // namespace
}  // namespace example

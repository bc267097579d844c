// Options that cannot be are refused with the field and the cure.
#include "surefoot/diagnose/options.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <string>

namespace surefoot {
namespace {

std::string complaint(const DiagnoseOptions& options) {
  try {
    check(options);
  } catch (const DiagnoseError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("the options that are given by default are in order") {
  CHECK(complaint({}).empty());
  CHECK(complaint({.max_effects = 0}).empty());
}

TEST_CASE("each option that cannot be is named") {
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  const auto names = [](const DiagnoseOptions& options, const std::string& field) {
    const std::string text = complaint(options);
    CAPTURE(text);
    CHECK(text.starts_with("DiagnoseOptions::" + field));
  };
  names({.held_out = {"a", "b", "a"}}, "held_out names 'a' more than once");
  names({.held_out_share = -0.1}, "held_out_share");
  names({.held_out_share = 1.1}, "held_out_share");
  names({.held_out_share = not_a_number}, "held_out_share");
  names({.effects = {"ghost"}}, "effects: there is no effect called 'ghost'");
  names({.more_effects = {Effect{}}}, "more_effects[0] has no name");
  names({.known = {{.name = "leak", .attached_to = "level", .values = {not_a_number}}}},
        "known: a parameter of 'leak'");
  names({.max_effects = -1}, "max_effects");
  names({.max_seconds = 0}, "max_seconds");
  names({.max_seconds = not_a_number}, "max_seconds");
}

TEST_CASE("effects of the user's own may be asked for") {
  Effect wind;
  wind.name = "wind";
  wind.force = [](const EffectContext&, Values, Values) { return 1.0; };
  CHECK(complaint({.effects = {"wind"}, .more_effects = {wind}}).empty());
}

TEST_CASE("an effect that does not exist is answered with those that do, each once") {
  const std::string text = complaint({.effects = {"drag"}});
  CHECK(text.find("'drag'") != std::string::npos);
  for (const char* one : {"quadratic_drag", "coulomb_friction"}) {
    CHECK(text.find(one) != std::string::npos);
    CHECK(text.find(one) == text.rfind(one));
  }
}

}  // namespace
}  // namespace surefoot

// When the time of a diagnosis is over, for the search and for all.
#include "surefoot/diagnose/verdict/run_context.hpp"

#include <doctest/doctest.h>

#include <string>

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("the search ends before all of the time is over, and at once when it is stopped") {
  using std::chrono::seconds;
  DiagnoseOptions options{.max_seconds = 100};
  const Parallel parallel = serially();
  const auto after = [&](int passed, std::stop_token stop = {}) {
    return RunContext{options, parallel, 1, stop, std::chrono::steady_clock::now() - seconds(passed)};
  };
  CHECK_FALSE(after(80).search_has_ended());
  CHECK(after(90).search_has_ended());
  CHECK_FALSE(after(90).has_ended());
  CHECK(after(110).has_ended());
  std::stop_source source;
  CHECK_FALSE(after(0, source.get_token()).has_ended());
  source.request_stop();
  CHECK(after(0, source.get_token()).has_ended());
}

TEST_CASE("progress is told to those who ask") {
  std::string told;
  DiagnoseOptions options;
  const Parallel parallel = serially();
  RunContext{options, parallel}.progress("calibrating", 0.5);  // nobody asks
  options.on_progress = [&](std::string_view stage, double share, std::string_view best) {
    told = std::string(stage) + " " + std::to_string(share).substr(0, 3) + " " + std::string(best);
  };
  RunContext{options, parallel}.progress("calibrating", 0.5, "friction");
  CHECK(told == "calibrating 0.5 friction");
}

}  // namespace
}  // namespace surefoot::diagnosis

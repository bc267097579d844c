#include "surefoot/motion/changes/walk_noise.hpp"

#include <doctest/doctest.h>

#include "surefoot/motion/monitor/recursive_update.hpp"
#include "tests/support/walks.hpp"

TEST_CASE("noise that doubled is seen in its component") {
  const surefoot::MotionNoise then{.constant = {0.01, 0.01, 0.03}}, now{.constant = {0.01, 0.02, 0.03}};
  const auto before = toys::walks(toys::paper_walk(), then, 20, 1), after = toys::walks(toys::paper_walk(), now, 10, 2);
  const surefoot::AnyMotionModel start = toys::paper_walk();
  const surefoot::ParameterPrior prior{start.parameters(), surefoot::prior_information(start)};
  const auto old_fit = surefoot::fit_sequences(before, start, then, toys::exact, prior),
             new_fit = surefoot::fit_sequences(after, start, then, toys::exact, prior);
  for (const bool every_cycle : {true, false}) {
    const auto old_walks = every_cycle ? before : toys::final_poses(before);
    const auto result = surefoot::detail::compare_noise({old_fit, old_walks, 0}, {new_fit, after, 0}, then, toys::exact, 1);
    REQUIRE(result.components.size() == (every_cycle ? 3 : 1));
    if (!every_cycle) continue;
    CHECK(result.components[1].change.log_bayes_factor > 10);
    CHECK(result.components[1].after == doctest::Approx(0.02).epsilon(0.1));
    CHECK(result.components[0].change.log_bayes_factor < 0);
    CHECK(result.after.constant[1] == doctest::Approx(0.02).epsilon(0.1));
  }
}

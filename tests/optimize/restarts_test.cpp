#include "surefoot/optimize/restarts.hpp"

#include <doctest/doctest.h>

#include <cstdint>

namespace surefoot {
namespace {

RestartSchedule schedule_of(Eigen::Index population) {
  return {.first_population = population, .large_population = population};
}

TEST_CASE("without restarts there is no next descent") {
  CHECK_FALSE(schedule_of(8).next(Restarts::none, 9, 2, Rng(1)));
}

TEST_CASE("IPOP doubles the population until its restarts are used up") {
  RestartSchedule schedule = schedule_of(8);
  for (const Eigen::Index population : {16, 32, 64}) {
    const DescentPlan plan = schedule.next(Restarts::ipop, 3, 2, Rng(1)).value_or(DescentPlan{});
    CHECK(plan.population == population);
    CHECK(plan.sigma_factor == 1);
  }
  CHECK_FALSE(schedule.next(Restarts::ipop, 3, 2, Rng(1)));
}

TEST_CASE("BIPOP spends about as much on small populations as on large ones") {
  RestartSchedule schedule = schedule_of(10);
  DescentPlan plan{.population = 10};
  std::uint64_t large = 0, small = 0;
  for (std::uint64_t descent = 0; descent < 60; ++descent) {
    const auto used = std::min<std::uint64_t>(100 * static_cast<std::uint64_t>(plan.population), plan.max_evaluations);
    if (descent > 0) (plan.small ? small : large) += used;
    schedule.finished(plan, descent, used);
    const auto next = schedule.next(Restarts::bipop, 9, 2, Rng(7, descent));
    if (!next) break;
    plan = *next;
    if (plan.small) {
      CHECK(plan.population >= 10);
      CHECK(plan.population <= std::max<Eigen::Index>(10, schedule.large_population / 2));
      CHECK(plan.sigma_factor <= 1);
      CHECK(plan.sigma_factor >= 0.01);
      CHECK(plan.max_evaluations == schedule.last_large_evaluations / 2);
    } else {
      CHECK(plan.population == schedule.large_population);
    }
  }
  CHECK(large > 0);
  CHECK(small + 100 * static_cast<std::uint64_t>(schedule.large_population) >= large);
  CHECK(small <= large + schedule.last_large_evaluations);
}

}  // namespace
}  // namespace surefoot

// The conditions of a servo: every finding in every condition, and what the whole group asks for.
#include "examples/sigmaban/robot/servos/servo_condition.hpp"

#include <doctest/doctest.h>

#include <array>
#include <optional>

#include "examples/sigmaban/robot/servos/servo_care.hpp"

using namespace dynamixel;

namespace {

constexpr std::array conditions{Condition::working, Condition::silent, Condition::returned, Condition::restoring,
                                Condition::failed};
constexpr std::array findings{Finding::fit,         Finding::reset,       Finding::shut_down, Finding::broken,
                              Finding::implausible, Finding::fell_silent, Finding::heard,     Finding::silent_for_long};

struct Cell {
  Condition next;
  Reaction reaction = Reaction::go_on;
};

/// A row for each condition, a column for each finding, in the orders above.
constexpr Cell transitions[5][8] = {
    // working
    {{Condition::working},
     {Condition::restoring, Reaction::restore},
     {Condition::failed, Reaction::sit_down},
     {Condition::failed, Reaction::let_go},
     {Condition::failed, Reaction::let_go},
     {Condition::silent},
     {Condition::working},
     {Condition::failed, Reaction::sit_down}},
    // silent
    {{Condition::working},
     {Condition::restoring, Reaction::restore},
     {Condition::failed, Reaction::sit_down},
     {Condition::failed, Reaction::let_go},
     {Condition::failed, Reaction::let_go},
     {Condition::silent},
     {Condition::returned},
     {Condition::failed, Reaction::sit_down}},
    // returned
    {{Condition::working},
     {Condition::restoring, Reaction::restore},
     {Condition::failed, Reaction::sit_down},
     {Condition::failed, Reaction::let_go},
     {Condition::failed, Reaction::let_go},
     {Condition::silent},
     {Condition::returned},
     {Condition::failed, Reaction::sit_down}},
    // restoring
    {{Condition::working},
     {Condition::restoring, Reaction::restore},
     {Condition::failed, Reaction::sit_down},
     {Condition::failed, Reaction::let_go},
     {Condition::failed, Reaction::let_go},
     {Condition::silent},
     {Condition::restoring},
     {Condition::failed, Reaction::sit_down}},
    // failed
    {{Condition::failed},
     {Condition::failed},
     {Condition::failed},
     {Condition::failed, Reaction::let_go},
     {Condition::failed, Reaction::let_go},
     {Condition::failed},
     {Condition::failed},
     {Condition::failed}},
};

}  // namespace

TEST_CASE("every finding in every condition has one consequence") {
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    for (std::size_t j = 0; j < findings.size(); ++j) {
      CAPTURE(i);
      CAPTURE(j);
      const ConditionStep step = after({.condition = conditions[i]}, findings[j]);
      CHECK(step.next.condition == transitions[i][j].next);
      CHECK(step.reaction == transitions[i][j].reaction);
    }
  }
}

TEST_CASE("a servo is restored a few times, and no more") {
  const ConditionCriteria criteria{.most_attempts = 3, .most_restored = 2};
  ServoCondition servo;
  for (int attempt = 1; attempt <= 3; ++attempt) {
    const ConditionStep step = after(servo, Finding::reset, criteria);
    CHECK(step.reaction == Reaction::restore);
    CHECK(step.next.attempts == attempt);
    servo = step.next;
  }
  CHECK(after(servo, Finding::reset, criteria).reaction == Reaction::sit_down);
  servo = {};
  for (int time = 1; time <= 2; ++time) {
    servo = after(servo, Finding::reset, criteria).next;
    servo = after(servo, Finding::fit, criteria).next;
    CHECK(servo == ServoCondition{.condition = Condition::working, .attempts = 0, .restored = time});
  }
  CHECK(after(servo, Finding::reset, criteria) ==
        ConditionStep{{.condition = Condition::failed, .attempts = 0, .restored = 2}, Reaction::sit_down});
}

TEST_CASE("nothing is worse for a servo that has more severe findings") {
  for (const Condition condition : conditions) {
    for (const Finding finding : findings) {
      const ConditionStep step = after({.condition = condition}, finding);
      CHECK((step.reaction < Reaction::sit_down || step.next.condition == Condition::failed));
    }
  }
}

TEST_CASE("a group lets go where a quarter of it is limp, or a third is silent for long") {
  const auto reaction = [](int limp, int silent, double lasts_s) {
    return group_reaction({.joints = 12, .limp = limp, .silent = silent, .silence_lasts_s = lasts_s});
  };
  CHECK(reaction(0, 0, 0) == Reaction::go_on);
  CHECK(reaction(3, 0, 0) == Reaction::go_on);
  CHECK(reaction(4, 0, 0) == Reaction::let_go);
  CHECK(reaction(0, 12, 0.2) == Reaction::go_on);
  CHECK(reaction(0, 5, 0.4) == Reaction::let_go);
  CHECK(reaction(0, 4, 10) == Reaction::go_on);  // each of them sits it down by itself
  CHECK(group_reaction({.joints = 1, .limp = 0, .silent = 1, .silence_lasts_s = 1}) == Reaction::let_go);
  CHECK(group_reaction({.joints = 2, .limp = 1, .silent = 0, .silence_lasts_s = 0}) == Reaction::go_on);
}

TEST_CASE("each servo is asked in turn, every other time one that is in doubt, never one that is silent") {
  ServoCare care(5, {});
  care.begin();
  static_cast<void>(care.take(1, Finding::fell_silent));
  static_cast<void>(care.take(3, Finding::reset));
  std::array<int, 5> asked{};
  for (int i = 0; i < 80; ++i) {
    const auto joint = care.next_to_ask([](std::size_t) { return false; });
    REQUIRE(joint.has_value());
    ++asked[*joint];
  }
  CHECK(asked == std::array{10, 0, 10, 50, 10});
  CHECK(care.reaction() == Reaction::go_on);
  CHECK_FALSE(care.fault());
}

TEST_CASE("the first fault is the one that is told, the worst reaction the one that is done") {
  ServoCare care(8, {});
  care.begin();
  static_cast<void>(care.take(2, Finding::shut_down));
  CHECK(care.reaction() == Reaction::sit_down);
  static_cast<void>(care.take(5, Finding::broken));
  CHECK(care.reaction() == Reaction::let_go);
  REQUIRE(care.fault());
  CHECK(care.fault()->joint == 2);
  CHECK(care.fault()->finding == Finding::shut_down);
  care.begin();
  for (const std::size_t joint : {0U, 1U, 2U, 3U}) static_cast<void>(care.take(joint, Finding::fell_silent));
  care.look(from_seconds(1));
  CHECK(care.reaction() == Reaction::go_on);
  care.look(from_seconds(1.4));
  CHECK(care.reaction() == Reaction::let_go);
}

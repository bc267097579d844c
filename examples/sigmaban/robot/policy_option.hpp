// The option --policy: the expert that won RoboCup 2016, with its own or tuned parameters, or a trained policy.
#pragma once

#include <string>

#include "../approach/any_policy.hpp"
#include "../approach/motion.hpp"

namespace sigmaban {

inline constexpr const char* policy_help =
    "expert (hand-tuned, RoboCup 2016), tuned (the same by CMA-ES, published), or a file written by "
    "sigmaban_approach train or tune";

/// Throws surefoot::Error if there is no such policy, or if it was trained for another walk.
template <class Problem>
AnyPolicyOf<Problem> load_policy_option(const Problem& problem, const std::string& name,
                                        const std::string& motion_file) {
  if (name == "expert") return Winner2016(Winner2016Parameters::winner2016());
  if (const auto expert = load_winner2016(name)) return *expert;
  check_motion(name, motion_file);
  return surefoot::load_policy<Problem>(problem, name);
}

}  // namespace sigmaban

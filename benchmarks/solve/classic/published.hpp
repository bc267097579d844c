// Returns that others published for the same problems; printed beside ours, never mixed with them.
#pragma once

#include <array>
#include <string_view>

namespace classic {

struct Published {
  std::string_view problem;
  std::string_view method;
  double mean;
  std::string_view source;
};

inline constexpr std::array<Published, 8> published{{
    {"pendulum", "TD3", -151.9, "RL Baselines3 Zoo"},
    {"pendulum", "SAC", -157.0, "RL Baselines3 Zoo"},
    {"pendulum", "PPO", -172.2, "RL Baselines3 Zoo"},
    {"mountain_car", "SAC", 94.7, "RL Baselines3 Zoo"},
    {"approach_ha", "RFPI, 3 h on 40 threads", -11.88, "Hofer and Rouxel, ICAPS 2017"},
    {"approach_anha", "RFPI, 3 h on 40 threads", -15.97, "Hofer and Rouxel, ICAPS 2017"},
    {"approach_ha", "rl-tools TD3, 180 CPU s", -9.22, "measured with rl-tools"},
    {"approach_anha", "rl-tools TD3, 180 CPU s", -11.66, "measured with rl-tools"},
}};

}  // namespace classic

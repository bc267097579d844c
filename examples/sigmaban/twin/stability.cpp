// `stability`: what the stabilisation is worth: falls and noise of the walk with and without it, on grounds of several
// kinds and under pushes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "../../../apps/calibrate/stoppable.hpp"
#include "commands.hpp"
#include "progress_line.hpp"
#include "share.hpp"
#include "surefoot/motion/plan.hpp"
#include "twin_sequence.hpp"

namespace sigmaban {
namespace {

struct StabilityOptions {
  TwinOptions twin;
  int sequences = 60, cycles = 25;
  double impulse = 1.0;  // of pushes [N s]
};

/// Where the robot walks.
struct Ground {
  std::string name;
  TwinSwitches switches;
  double impulse = 0;  // of pushes [N s]
};

/// The plain ground, pushes on it, slopes, and a ground that gives way. Across a slope of 0.05 rad it cannot even
/// begin.
std::vector<Ground> grounds(const StabilityOptions& options) {
  constexpr double ahead = 0.05, across = 0.02;  // slopes [rad]
  const TwinSwitches plain = walking_twin_options(options.twin).switches;
  std::vector<Ground> all{{"flat", plain}, {"flat, pushes", plain, options.impulse}};
  const auto add = [&](const char* name, double TwinSwitches::*member, double value) {
    all.push_back({name, plain});
    all.back().switches.*member = value;
  };
  add("falling slope", &TwinSwitches::slope_forward, ahead);
  add("rising slope", &TwinSwitches::slope_forward, -ahead);
  add("slope to the left", &TwinSwitches::slope_left, across);
  add("soft ground", &TwinSwitches::soft_ground, 0.03);
  all.push_back({"soft ground, pushes", all.back().switches, options.impulse});
  return all;
}

void print(const char* way, const std::vector<TwinSequence>& walks) {
  const auto falls = static_cast<std::size_t>(std::ranges::count_if(walks, &TwinSequence::fell));
  const Share fell{falls, walks.size()};
  constexpr std::size_t least_cycles = 20;  // for gains and noise
  std::size_t cycles = 0;
  for (const TwinSequence& walk : walks) cycles += walk.moved.size();
  if (cycles < least_cycles) {
    std::printf("  %-8s %4zu of %4zu, before they could be measured\n", way, falls, walks.size());
    return;
  }
  const surefoot::Vec<3> noise = displacement_noise(walks);
  const auto gains = walk_gains(walks);
  std::printf("  %-8s %4zu of %4zu (%5.1f to %5.1f %%)  %7.1f %7.1f %8.1f   %5.2f %5.2f %5.2f\n", way, falls,
              walks.size(), 100 * fell.low(), 100 * fell.high(), 1e3 * noise[0], 1e3 * noise[1], 1e3 * noise[2],
              gains(0, 1), gains(1, 2), gains(2, 3));
  std::fflush(stdout);
}

void run(const StabilityOptions& options) {
  const auto commands =
      surefoot::plan_commands(surefoot::CommandBounds(), options.sequences, options.cycles, options.twin.seed);
  calibrate_program::until_interrupted(options.twin.threads, [&](const calibrate_program::StoppableThreads& threads) {
    std::printf("pushes of %.2f N s in any direction, one in every 3 s\n", options.impulse);
    std::printf("  %-8s %30s  %24s   %17s\n", "", "falls (95 %)", "noise of a cycle [mm mrad]", "gains");
    for (const Ground& ground : grounds(options)) {
      std::printf("%s\n", ground.name.c_str());
      for (const bool stabilized : {false, true}) {
        WalkingTwinOptions twin = walking_twin_options(options.twin);
        twin.switches = ground.switches;
        twin.pushes.impulse = ground.impulse;
        twin.stabilized = stabilized;
        const auto walks =
            record_sequences(twin, commands, options.twin.seed, threads, ProgressLine("sequences", commands.size()));
        if (threads.token.stop_requested()) return;
        print(stabilized ? "with" : "without", walks);
      }
    }
  });
}

}  // namespace

void add_stability(example::Command& program) {
  auto options = std::make_shared<StabilityOptions>();
  example::Command* command =
      program.add_subcommand("stability", "Falls and noise of the walk with and without the stabilisation");
  add_sequence_options(*command, options->sequences, options->cycles);
  command->add_option("--impulse", options->impulse, "of a push [N s]")
      ->check(example::between(0.0, 10.0))
      ->capture_default_str();
  add_twin_options(*command, options->twin);
  command->callback([options] { run(*options); });
}

}  // namespace sigmaban

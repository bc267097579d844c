// `gains`: how the twin walks, in a few figures.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

#include "../../../apps/calibrate/stoppable.hpp"
#include "commands.hpp"
#include "progress_line.hpp"
#include "share.hpp"
#include "surefoot/motion/plan.hpp"
#include "twin_sequence.hpp"

namespace sigmaban {
namespace {

struct GainsOptions {
  TwinOptions twin;
  int sequences = 200, cycles = 25;
};

void print(const std::vector<TwinSequence>& sequences, double cpu_seconds) {
  const auto falls = static_cast<std::size_t>(std::ranges::count_if(sequences, &TwinSequence::fell));
  const Share upright{sequences.size() - falls, sequences.size()};
  std::printf("without a fall: %zu of %zu sequences, %.1f %% (95 %%: %.1f to %.1f)\n", upright.yes, upright.trials,
              100 * upright.value(), 100 * upright.low(), 100 * upright.high());
  const auto gains = walk_gains(sequences);
  const surefoot::Vec<3> rest = gains_residual(sequences, gains);
  std::printf("displacement of a cycle = A (1, commands of the cycle):  [m, m, rad]\n");
  constexpr const char* names[] = {"forward", "left", "turn"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    std::printf("  %-8s %8.4f %7.3f %7.3f %7.3f   unexplained %.4f\n", names[i], gains(i, 0), gains(i, 1), gains(i, 2),
                gains(i, 3), rest[i]);
  }
  double simulated = 0;
  for (const TwinSequence& sequence : sequences) simulated += sequence.simulated;
  std::printf("gains: forward %.3f, left %.3f, turn %.3f\n", gains(0, 1), gains(1, 2), gains(2, 3));
  std::printf("%.0f s were simulated in %.1f s of one core: %.1f times real time\n", simulated, cpu_seconds,
              simulated / cpu_seconds);
}

void run(const GainsOptions& options) {
  const WalkingTwinOptions twin = walking_twin_options(options.twin);
  const auto commands =
      surefoot::plan_commands(surefoot::CommandBounds(), options.sequences, options.cycles, options.twin.seed);
  calibrate_program::until_interrupted(options.twin.threads, [&](const calibrate_program::StoppableThreads& threads) {
    const std::clock_t began = std::clock();  // of all threads together
    const auto sequences =
        record_sequences(twin, commands, options.twin.seed, threads, ProgressLine("sequences", commands.size()));
    if (!sequences.empty()) print(sequences, static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC);
  });
}

}  // namespace

void add_gains(example::Command& program) {
  auto options = std::make_shared<GainsOptions>();
  example::Command* command =
      program.add_subcommand("gains", "Measure falls, gains of the walk, and speed of the simulation");
  add_sequence_options(*command, options->sequences, options->cycles);
  add_twin_options(*command, options->twin);
  command->callback([options] { run(*options); });
}

}  // namespace sigmaban

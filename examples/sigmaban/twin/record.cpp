// `record`: sequences of walk commands and where the twin got by them, as CSV.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "../../../apps/calibrate/load_sequences.hpp"
#include "../../../apps/calibrate/stoppable.hpp"
#include "../../../apps/common/files.hpp"
#include "commands.hpp"
#include "progress_line.hpp"
#include "surefoot/motion/plan.hpp"
#include "twin_sequence.hpp"

namespace sigmaban {
namespace {

struct RecordOptions {
  TwinOptions twin;
  int sequences = 25, cycles = 25;
  std::filesystem::path commands, out, joints;
};

/// Per cycle, one matrix per sequence.
std::vector<Eigen::Matrix3Xd> commands_of(const RecordOptions& options) {
  if (options.commands.empty()) {
    return surefoot::plan_commands(surefoot::CommandBounds(), options.sequences, options.cycles, options.twin.seed);
  }
  calibrate_program::LoadOptions load;
  load.usual_steps = steps_per_cycle;
  load.poses_needed = false;
  std::vector<Eigen::Matrix3Xd> commands;
  for (auto& sequence : calibrate_program::load_sequences({options.commands}, load).sequences) {
    commands.push_back(std::move(sequence.commands));
  }
  return commands;
}

void run(const RecordOptions& options) {
  const WalkingTwinOptions twin = walking_twin_options(options.twin);
  const std::vector<Eigen::Matrix3Xd> commands = commands_of(options);
  example::prepare_output(options.out);
  if (!options.joints.empty()) example::prepare_output(options.joints);
  calibrate_program::until_interrupted(options.twin.threads, [&](const calibrate_program::StoppableThreads& threads) {
    const auto sequences = record_sequences(twin, commands, options.twin.seed, threads,
                                            ProgressLine("sequences", commands.size()), !options.joints.empty());
    const auto falls = std::ranges::count_if(sequences, &TwinSequence::fell);
    example::write_text(options.out, sequences_csv(sequences));
    if (!options.joints.empty()) example::write_text(options.joints, joints_csv(sequences));
    std::printf("%s: %zd sequences", options.out.c_str(), std::ssize(sequences) - falls);
    if (falls > 0) std::printf("; %zd more ended in a fall and are left out", falls);
    std::printf("\n");
  });
}

}  // namespace

void add_record(example::Command& program) {
  auto options = std::make_shared<RecordOptions>();
  example::Command* command =
      program.add_subcommand("record", "Write what is recorded of the twin: commands, displacement and pose per cycle");
  command->footer(
      "Commands in the file are per step, a cycle has two: tell surefoot-calibrate --steps-per-cycle 2.\n"
      "Ctrl-C ends early and keeps the sequences that are done.");
  add_sequence_options(*command, options->sequences, options->cycles);
  command
      ->add_option("--commands,--orders", options->commands,
                   "CSV file of commands in place of random ones, as written by surefoot-calibrate plan or by record")
      ->check(example::existing_file());
  add_twin_options(*command, options->twin);
  command->add_option("--joints", options->joints, "CSV file for the joints: goals, positions, currents");
  command->add_option("--out", options->out, "CSV file to write")->required();
  command->callback([options] { run(*options); });
}

}  // namespace sigmaban

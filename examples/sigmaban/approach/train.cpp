#include "train.hpp"

#include <memory>

#include "../../../apps/common/command.hpp"
#include "commands.hpp"
#include "surefoot/core/executor.hpp"

namespace sigmaban {

void add_train_by(example::Command& program, std::size_t threads, std::function<void(const TrainOptions&)> work) {
  auto options = std::make_shared<TrainOptions>();
  options->threads = threads;
  example::Command* command =
      program.add_subcommand("train", "Train a policy by RFPI; Ctrl-C ends early and keeps the best");
  add_problem_option(*command, options->problem);
  add_motion_option(*command, options->motion);
  command
      ->add_option("--budget", options->budget,
                   "work in seconds of one nominal core, all threads together: the same policy on any machine")
      ->check(example::between(0.1, 1e7))
      ->capture_default_str();
  command->add_option("--max-wall", options->wall, "[s] hard limit by the clock")->check(example::between(0.1, 1e7));
  command->add_option("--seed", options->seed, "same seed, same policy")->capture_default_str();
  add_threads_option(*command, options->threads);
  command->add_option("--out", options->out, "policy file; FILE.json tells how it was trained")->required();
  command->add_option("--preset", options->preset, "default: ours; paper: the settings of the paper")
      ->check(example::one_of({"default", "paper"}))
      ->capture_default_str();
  command->add_option("--checkpoint-every", options->checkpoint_seconds, "[s] between two writes of FILE.checkpoint")
      ->check(example::between(0.0, 1e7))
      ->capture_default_str();
  command->add_flag("--resume", options->resume, "go on from FILE.checkpoint, if it is there");
  command->callback([options, work] { work(*options); });
}

void train_on_threads(const TrainOptions& options) {
  train_on(options, [](const TrainOptions& o) { return std::make_unique<surefoot::Threads>(o.threads); });
}

void add_train(example::Command& program) { add_train_by(program, 0, train_on_threads); }

}  // namespace sigmaban

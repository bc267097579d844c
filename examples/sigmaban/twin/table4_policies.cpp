#include "table4_policies.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "../../../apps/calibrate/fit_walk.hpp"
#include "../../../apps/calibrate/stoppable.hpp"
#include "../../../apps/common/files.hpp"
#include "../approach/results.hpp"
#include "../approach/train_options.hpp"
#include "../approach/tune_options.hpp"
#include "progress_line.hpp"
#include "surefoot/motion/plan.hpp"
#include "table4.hpp"
#include "twin_sequence.hpp"

namespace sigmaban {
namespace {

void say(const std::string& what) {
  std::printf("== %s\n", what.c_str());
  std::fflush(stdout);
}

void calibrate(const Table4Work& work) {
  if (exists(work.motion())) return;
  if (!work.given_motion.empty()) return example::write_text(work.motion(), example::read_text(work.given_motion));
  say("recording and calibrating the twin");
  const auto commands = surefoot::plan_commands(surefoot::CommandBounds(), work.sequences, work.cycles, work.twin.seed);
  calibrate_program::until_interrupted(work.twin.threads, [&](const calibrate_program::StoppableThreads& threads) {
    const auto walks = record_sequences(walking_twin_options(work.twin), commands, work.twin.seed, threads,
                                        ProgressLine("sequences", commands.size()));
    if (threads.token.stop_requested()) return;
    std::vector<surefoot::WalkSequence> sequences;
    for (const TwinSequence& walk : walks) {
      if (!walk.fell) sequences.push_back(walk_sequence(walk));
    }
    calibrate_program::FitSettings settings;
    settings.position_accuracy = 0.0005;  // of the physics engine: the poses are exact but for their digits [m]
    settings.heading_accuracy = 0.001;    // [rad]
    auto fitted = calibrate_program::fit_walk(sequences, {}, settings, threads);
    fitted.file.steps_per_cycle = steps_per_cycle;
    calibrate_program::write_motion_file(work.motion(), fitted.file);
  });
}

/// Calls make(unfinished name) and gives the file its name when it is finished.
void make_file(const std::filesystem::path& file, const std::string& what,
               const std::function<void(const std::filesystem::path&)>& make) {
  if (exists(file)) return;
  say(what);
  const std::filesystem::path unfinished = file.parent_path() / ("unfinished_" + file.filename().string());
  make(unfinished);
  if (exists(record_of(unfinished))) rename(record_of(unfinished), record_of(file));
  rename(unfinished, file);
}

}  // namespace

void make_table4_policies(const Table4Work& work) {
  calibrate(work);
  const Results results{work.folder};
  for (const std::string_view name : table4_problems) {
    const std::string problem(name);
    make_file(results.tuned(problem), "tuning the expert by CMA-ES, " + problem, [&](const auto& out) {
      tune_winner2016({.problem = problem,
                       .motion = work.motion(),
                       .budget = work.tune_budget,
                       .seed = work.twin.seed,
                       .threads = work.twin.threads,
                       .out = out});
    });
    make_file(results.rfpi(problem), "training by RFPI, " + problem, [&](const auto& out) {
      train_on_threads({.problem = problem,
                        .motion = work.motion(),
                        .budget = work.train_budget,
                        .seed = work.twin.seed,
                        .threads = work.twin.threads,
                        .out = out,
                        .checkpoint_seconds = 5,
                        .resume = true});
    });
  }
}

}  // namespace sigmaban

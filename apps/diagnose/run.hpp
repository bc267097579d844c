// A diagnosis from the command line to the files, for any simulator.
#pragma once

#include <string_view>

#include "../common/interrupt.hpp"
#include "command_line.hpp"
#include "known_effects.hpp"
#include "layout.hpp"
#include "load_all.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"

namespace diagnose_program {

inline constexpr int exit_done = 0, exit_wrong_input = 2, exit_interrupted = 130;

/// `model` is null for a simulator in C++.
template <surefoot::Simulator S>
int run(const S& simulator, const Layout& layout, const CommandLine& line, const ModelFile* model) {
  LoadedRecordings loaded = load_all(line, layout);
  surefoot::DiagnoseOptions options;
  if (model != nullptr) options.known = known_effects(*model, surefoot::all_effects());
  options.held_out = test_names(line, loaded.recordings);
  options.held_out_share = line.test_share;
  options.effects = line.effects;
  options.max_effects = line.max_effects;
  if (line.budget > 0) options.max_seconds = line.budget;
  prepare_folder(line.out);
  example::Interrupt interrupt;
  Progress progress(line.quiet);
  options.on_progress = [&progress](std::string_view stage, double share, std::string_view best) {
    progress.show(stage, share, best);
  };
  surefoot::Diagnosis diagnosis = surefoot::diagnose(simulator, loaded.recordings, options,
                                                     surefoot::Threads(line.threads), line.seed, interrupt.token());
  progress.close();
  diagnosis.remarks.insert(diagnosis.remarks.begin(), loaded.remarks.begin(), loaded.remarks.end());
  write_results(diagnosis, simulator.info(), line.out, model);
  if (!line.quiet) print_summary(diagnosis, line.out);
  return diagnosis.complete ? exit_done : exit_interrupted;
}

}  // namespace diagnose_program

#include "run.hpp"

#include <algorithm>
#include <exception>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../common/interrupt.hpp"
#include "known_effects.hpp"
#include "load_all.hpp"
#include "names.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"

namespace diagnose_program {
namespace {

void check_effects(const std::vector<std::string>& wanted) {
  const std::vector<std::string> names = names_of_effects(surefoot::all_effects());
  for (const std::string& name : wanted) {
    if (std::ranges::find(names, name) != names.end()) continue;
    throw surefoot::DiagnoseError("--effects: there is no effect called " + in_quotes(name) + suggestion(name, names));
  }
}

}  // namespace

int guarded(int argc, char** argv, bool with_model, const std::function<int(const CommandLine&)>& work) {
  try {
    const std::optional<CommandLine> line = parse_command_line(argc, argv, with_model);
    return line ? work(*line) : exit_done;
  } catch (const surefoot::Error& error) {
    std::cerr << "surefoot-diagnose: " << error.what() << '\n';
    return exit_wrong_input;
  } catch (const std::exception& error) {
    std::cerr << "surefoot-diagnose: " << error.what() << '\n';
    return 1;
  }
}

int run(const surefoot::SimulatorInfo& info, const surefoot_apps::DiagnoseFunction& diagnose, const Layout& layout,
        const CommandLine& line, const ModelFile* model) {
  check_effects(line.effects);
  LoadedRecordings loaded = load_all(line, layout);
  surefoot::DiagnoseOptions options;
  if (model != nullptr) options.known = known_effects(*model, surefoot::all_effects());
  options.held_out = test_names(line, loaded.recordings);
  options.held_out_share = line.test_share;
  options.effects = line.effects;
  options.max_effects = line.max_effects;
  options.max_rows = line.max_rows;
  options.repair = line.repair;
  if (line.budget > 0) options.max_seconds = line.budget;
  prepare_folder(line.out);
  example::Interrupt interrupt;
  Progress progress(line.quiet);
  options.on_progress = [&progress](std::string_view stage, double share, std::string_view best) {
    progress.show(stage, share, best);
  };
  surefoot::Diagnosis diagnosis =
      diagnose(loaded.recordings, options, surefoot::Threads(line.threads), line.seed, interrupt.token());
  progress.close();
  diagnosis.remarks.insert(diagnosis.remarks.begin(), loaded.remarks.begin(), loaded.remarks.end());
  write_results(diagnosis, info, line.out, model);
  if (!line.quiet) print_summary(diagnosis, line.out);
  return !diagnosis.complete && interrupt.requested() ? exit_interrupted : exit_done;
}

}  // namespace diagnose_program

namespace surefoot_apps {

int diagnose_main(int argc, char** argv, const surefoot::SimulatorInfo& info, const DiagnoseFunction& diagnose) {
  using namespace diagnose_program;
  return guarded(argc, argv, false,
                 [&](const CommandLine& line) { return run(info, diagnose, layout_of(info), line, nullptr); });
}

}  // namespace surefoot_apps

double surefoot::constant_of(const Recording& recording, const std::string& key) {
  const auto found = recording.constants.find(key);
  if (found != recording.constants.end()) return found->second;
  throw DiagnoseError(recording.name + ": the simulator wants the constant '" + key + "'; add a first line '# " + key +
                      ": number'");
}

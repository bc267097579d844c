// `fit`: the motion model that predicts best, how well it is known, and the noise of the walk.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "../common/files.hpp"
#include "commands.hpp"
#include "diagnose_model.hpp"
#include "final_poses.hpp"
#include "fit_report.hpp"
#include "sequence_options.hpp"

namespace calibrate_program {
namespace {

constexpr const char* formats = R"(Files that are read:
  many sequences in one file: columns seq, cycle, order_dx_m, order_dy_m, order_dtheta_rad, and at the end of each
  row's cycle x_m, y_m, theta_rad (empty: not measured). Each sequence starts at the origin, looking along x;
  one sequence per file (no column seq): the commands of a row lead from its pose to that of the next row;
  two wheels: one sequence per file with t_s, --wheels LEFT,RIGHT and --wheel-base M.
x is forward, y to the left, angles counterclockwise; columns in _cm and _deg are converted.
Writes motion.json, motion.toml (for surefoot-diagnose) and final_poses.svg and .png.)";

struct FitOptions {
  SequenceOptions read;
  std::string model = "auto";
  std::vector<std::filesystem::path> test;
  std::filesystem::path out;
};

void run(const FitOptions& options) {
  check(options.read);
  const LoadedSequences loaded = load_sequences(options.read.files, options.read.load);
  LoadedSequences test;
  if (!options.test.empty()) {
    LoadOptions whole = options.read.load;
    whole.final_only = false;
    test = load_sequences(options.test, whole);
  }
  warn_of_skipped(loaded);
  warn_of_skipped(test);
  example::prepare_output(options.out / "motion.json");
  FitSettings settings = fit_settings(options.read);
  settings.kind = model_named(options.model);
  until_interrupted(options.read.threads, [&](const StoppableThreads& executor) {
    FittedWalk fitted = fit_walk(loaded.sequences, test.sequences, settings, executor);
    fitted.file.steps_per_cycle = loaded.layout.steps_per_cycle;
    std::cout << fit_report(fitted) << std::flush;
    const bool held_out = !test.sequences.empty();
    draw_final_poses(options.out / "final_poses", fitted.file.model, held_out ? test.sequences : loaded.sequences,
                     held_out);
    example::write_text(options.out / "motion.toml", diagnose_model(fitted.file, fitted.determined, loaded.layout,
                                                                    options.read.load, loaded.sequences));
    write_motion_file(options.out / "motion.json", fitted.file);  // last: all is there
  });
  std::cout << "\nIn " << options.out.string() << ": motion.json, motion.toml, final_poses.svg and .png\n";
}

}  // namespace

void add_fit(example::Command& program) {
  auto options = std::make_shared<FitOptions>();
  example::Command* command = program.add_subcommand("fit", "Calibrate a motion model and its noise from recordings");
  command->footer(formats);
  add_reading_options(*command, options->read);
  command->add_option("--model", options->model, "auto: the simplest of those that predict best")
      ->check(example::one_of({"auto", "proportional", "simple", "full", "previous-command", "previous-order"}))
      ->capture_default_str();
  add_fitting_options(*command, options->read);
  command->add_option("--test", options->test,
                      "held-out recordings: no model is fitted to them, its errors on them are reported");
  command->add_option("--out", options->out, "folder for the results, made if needed")->required();
  add_work_options(*command, options->read);
  command->callback([options] { run(*options); });
}

}  // namespace calibrate_program

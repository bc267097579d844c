// `curve`: how the error falls with the number of sequences, and the coefficients with it: figures 3 and 4 of the
// paper.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "../common/files.hpp"
#include "commands.hpp"
#include "curve_files.hpp"
#include "curve_splits.hpp"
#include "sequence_options.hpp"
#include "surefoot/motion/compare.hpp"
#include "surefoot/motion/plan.hpp"

namespace calibrate_program {
namespace {

struct CurveOptions {
  SequenceOptions read;
  std::vector<std::size_t> counts;
  std::size_t repetitions = 200, validation = 5;
  std::filesystem::path out;
};

/// With a line of progress about every two seconds. Goes on with the splits that the folder holds.
surefoot::LearningCurve curve_of(ModelKind kind, const std::vector<surefoot::WalkSequence>& sequences,
                                 surefoot::LearningCurveOptions options, const StoppableThreads& executor,
                                 std::uint64_t seed, const std::filesystem::path& folder) {
  const surefoot::AnyMotionModel model = default_model(kind);
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  double shown = 0;  // [s]
  CurveSplits splits(folder / ("splits_" + std::string(file_name_of(kind)) + ".csv"),
                     curve_fingerprint(model, sequences, options, seed), options.counts);
  options.known = [&](std::size_t repetition) { return splits.known(repetition); };
  options.on_split = [&](std::size_t repetition, const auto& result) { splits.add(repetition, result); };
  options.on_progress = [&](std::size_t done) {
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (seconds < shown + 2 && done < options.repetitions) return;
    shown = seconds;
    const auto left = static_cast<double>(options.repetitions - done) * seconds / static_cast<double>(done);
    std::fprintf(stderr, "... %s: %zu of %zu splits, %.1f per second, %.0f s left\n", model.name().c_str(), done,
                 options.repetitions, static_cast<double>(done) / seconds, left);
  };
  return surefoot::learning_curve(model, sequences, options, executor, seed);
}

/// About fifteen counts, close together where the curve is steep.
std::vector<std::size_t> usual_counts(std::size_t most) {
  std::vector<std::size_t> counts;
  for (std::size_t count = 1; count < most; count += count < 10 ? 1 : count < 30 ? 3 : count / 5) {
    counts.push_back(count);
  }
  counts.push_back(most);
  return counts;
}

void print(const std::vector<CountedCurve>& curves, double as_commanded) {
  std::printf("Mean error of final positions [m] on held-out sequences, by the number fitted to:\n\n%-6s", "");
  for (const CountedCurve& curve : curves) std::printf(" %26.26s", curve.curve.model.c_str());
  std::printf("\n");
  for (std::size_t i = 0; i < curves[0].curve.counts.size(); ++i) {
    std::printf("%-6zu", curves[0].curve.counts[i]);
    const auto at = static_cast<Eigen::Index>(i);
    for (const CountedCurve& curve : curves) {
      std::printf("         %8.3f +- %6.3f", curve.curve.position[at], curve.curve.position_half_width[at]);
    }
    std::printf("\n");
  }
  std::printf("%-6s %26.3f  with the commands as they are\n\n%s\n", "any", as_commanded, which_model(curves).c_str());
}

void run(const CurveOptions& options) {
  check(options.read);
  const LoadedSequences loaded = load_sequences(options.read.files, options.read.load);
  warn_of_skipped(loaded);
  example::prepare_output(options.out / "curve.json");
  surefoot::LearningCurveOptions work;
  work.predictor = predictor_options(loaded.sequences, fit_settings(options.read));
  work.predictor.published.steps_where_determined = true;
  work.validation = options.validation;
  work.repetitions = options.repetitions;
  work.counts = options.counts;
  if (loaded.sequences.size() <= work.validation) {
    throw UsageError("only " + std::to_string(loaded.sequences.size()) + " sequences: --validation keeps " +
                     std::to_string(work.validation) + " of them, none is left to fit to; walk more or keep fewer");
  }
  if (work.counts.empty()) work.counts = usual_counts(loaded.sequences.size() - work.validation);
  std::vector<CountedCurve> curves;
  until_interrupted(options.read.threads, [&](const StoppableThreads& executor) {
    for (const ModelKind kind : all_models) {
      auto curve = curve_of(kind, loaded.sequences, work, executor, options.read.seed, options.out);
      const auto more = surefoot::more_sequences(curve, loaded.sequences.size());
      curves.push_back({kind, std::move(curve), more});
    }
  });
  const double as_commanded = surefoot::evaluate_commands(loaded.sequences).position;
  print(curves, as_commanded);
  write_curve_files(options.out, curves, as_commanded, work);
}

}  // namespace

void add_curve(example::Command& program) {
  auto options = std::make_shared<CurveOptions>();
  options->read.method = "published";  // the small models win with few sequences; a prior would hide that
  example::Command* command =
      program.add_subcommand("curve", "Show how many sequences each model needs, and how many more are worth walking");
  command->footer(
      "Reads the same files as `fit`. Writes curve.csv, curve.json, curve and coefficients as .svg and .png, and what "
      "goes\n"
      "into them as splits_MODEL.csv: Ctrl-C stops, the same command goes on.");
  add_reading_options(*command, options->read);
  command->add_option("--counts", options->counts, "of sequences to fit to, N,N,...; default: about fifteen of them")
      ->delimiter(',')
      ->check(example::between(1, 100'000));
  command->add_option("--repetitions", options->repetitions, "random splits")
      ->check(example::between(2, 100'000))
      ->capture_default_str();
  command->add_option("--validation", options->validation, "held-out sequences, for each fit")
      ->check(example::between(1, 100'000))
      ->capture_default_str();
  add_fitting_options(*command, options->read);
  command->add_option("--out", options->out, "folder for the results, made if needed")->required();
  add_work_options(*command, options->read);
  command->callback([options] { run(*options); });
}

}  // namespace calibrate_program

// `compare`: what changed in a walk since a former calibration or recording.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../common/files.hpp"
#include "commands.hpp"
#include "compare_report.hpp"
#include "motion_file/motion_file.hpp"
#include "sequence_options.hpp"
#include "surefoot/motion/one_sided_correction.hpp"
#include "surefoot/motion/walk_changes.hpp"

namespace calibrate_program {
namespace {

constexpr const char* compared_files =
    R"(OLD and NEW: one file each, or several by --old and --new. They are read as `fit` does; OLD may also be the
motion.json of a calibration, with its covariance and noise.
A statement is made if its posterior probability is at least --certainty. With --out, writes compare.json.)";

using Paths = std::vector<std::filesystem::path>;

struct CompareWalksOptions {
  SequenceOptions read;
  Paths both, before, after, joints_before, joints_after;
  std::string model = "auto";
  double certainty = surefoot::WalkChangeOptions().certainty;
  std::filesystem::path out;
};

void sort_files(CompareWalksOptions& options) {
  if (!options.both.empty()) {
    const bool two = options.both.size() == 2 && options.before.empty() && options.after.empty();
    if (!two) throw UsageError("compare needs OLD and NEW: one file each, or several by --old and --new");
    options.before = {options.both[0]};
    options.after = {options.both[1]};
  }
  if (options.before.empty() || options.after.empty()) {
    throw UsageError("compare needs both an old walk (OLD or --old) and a new one (NEW or --new)");
  }
}

bool is_calibration(const Paths& files) { return files.size() == 1 && files.front().extension() == ".json"; }

/// The cycles that most sequences have; none where they were meant to differ.
std::optional<Eigen::Index> usual_cycles(const LoadedSequences& loaded) {
  std::map<Eigen::Index, std::size_t> lengths;
  for (const surefoot::WalkSequence& sequence : loaded.sequences) ++lengths[sequence.cycles()];
  const auto usual = std::ranges::max_element(lengths, {}, [](const auto& length) { return length.second; });
  return 2 * usual->second > loaded.sequences.size() ? std::optional(usual->first) : std::nullopt;
}

/// The same of a new walk: as many as in the old one, if any has them, since most may have ended early.
std::optional<Eigen::Index> usual_cycles(const LoadedSequences& after, const LoadedSequences& before) {
  Eigen::Index longest = 0;
  for (const surefoot::WalkSequence& sequence : after.sequences) longest = std::max(longest, sequence.cycles());
  const auto usual = usual_cycles(before);
  return usual == longest ? usual : usual_cycles(after);
}

/// How many sequences have fewer cycles than usual, or no final position.
surefoot::FallCount falls_of(const LoadedSequences& loaded, std::optional<Eigen::Index> usual) {
  std::size_t fell = loaded.skipped.size();
  for (const surefoot::WalkSequence& sequence : loaded.sequences) fell += usual && sequence.cycles() < *usual ? 1 : 0;
  return {.fell = static_cast<int>(fell),
          .sequences = static_cast<int>(loaded.sequences.size() + loaded.skipped.size())};
}

/// As many coefficients as the recordings can tell apart: with final poses alone, what is done one cycle later and to
/// which side is hardly seen.
surefoot::AnyMotionModel model_for(const std::string& name, const LoadedSequences& before,
                                   const LoadedSequences& after) {
  const bool cycles = surefoot::sees_single_cycles(before.sequences) && surefoot::sees_single_cycles(after.sequences);
  if (name == "sides" || (name == "auto" && cycles)) return surefoot::OneSidedCorrection();
  return default_model(name == "auto" ? ModelKind::full : *model_named(name));
}

surefoot::WalkChangeOptions change_options(const CompareWalksOptions& options,
                                           const std::vector<surefoot::WalkSequence>& sequences) {
  const surefoot::PredictorOptions fit = predictor_options(sequences, fit_settings(options.read));
  return {.accuracy = fit.calibration.model.accuracy,
          .noise_scale = fit.calibration.noise_scale,
          .certainty = options.certainty};
}

ComparedWalks compare_with_recordings(const CompareWalksOptions& options) {
  const LoadedSequences before = load_sequences(options.before, options.read.load);
  LoadOptions load = options.read.load;
  load.usual_steps = before.layout.steps_per_cycle;
  const LoadedSequences after = load_sequences(options.after, load);
  if (before.layout.steps_per_cycle != after.layout.steps_per_cycle) {
    throw surefoot::MotionError("the old and the new walk have different steps per cycle; give --steps-per-cycle");
  }
  warn_of_skipped(before);
  warn_of_skipped(after);
  ComparedWalks walks{.comparison = {.before = default_model(ModelKind::full), .after = default_model(ModelKind::full)},
                      .falls = surefoot::WalkFalls{falls_of(before, usual_cycles(before)),
                                                   falls_of(after, usual_cycles(after, before))},
                      .before = before.sequences.size(),
                      .after = after.sequences.size(),
                      .certainty = options.certainty};
  walks.comparison =
      surefoot::compare_walks({.model = model_for(options.model, before, after), .recorded = before.sequences},
                              after.sequences, change_options(options, before.sequences), walks.falls);
  return walks;
}

ComparedWalks compare_with_calibration(const CompareWalksOptions& options) {
  const MotionFile file = read_motion_file(options.before.front());
  LoadOptions load = options.read.load;
  load.usual_steps = file.steps_per_cycle;
  const LoadedSequences after = load_sequences(options.after, load);
  warn_of_skipped(after);
  ComparedWalks walks{.comparison = {.before = default_model(file.kind), .after = default_model(file.kind)},
                      .falls = {},
                      .before = file.sequences,
                      .after = after.sequences.size(),
                      .certainty = options.certainty};
  const surefoot::FormerWalk before{.model = default_model(file.kind).with_parameters(file.parameters),
                                    .covariance = file.covariance,
                                    .noise = file.noise,
                                    .sequences = file.sequences,
                                    .readings = file.readings};
  walks.comparison = surefoot::compare_walks(
      before, after.sequences,
      {.accuracy = file.accuracy, .noise_scale = file.noise.scale, .certainty = options.certainty});
  return walks;
}

void run(CompareWalksOptions options) {
  check(options.read);
  sort_files(options);
  if (!options.out.empty()) example::prepare_output(options.out / "compare.json");
  ComparedWalks walks =
      is_calibration(options.before) ? compare_with_calibration(options) : compare_with_recordings(options);
  if (!options.joints_before.empty()) {
    walks.joints = compare_joints(read_joint_logs(options.joints_before), read_joint_logs(options.joints_after));
  }
  std::cout << compare_report(walks) << std::flush;
  if (options.out.empty()) return;
  example::write_text(options.out / "compare.json", compare_json(walks));
  std::cout << "In " << options.out.string() << ": compare.json\n";
}

}  // namespace

void add_compare(example::Command& program) {
  auto options = std::make_shared<CompareWalksOptions>();
  example::Command* command =
      program.add_subcommand("compare", "What changed in a walk since a former calibration or recording");
  command->footer(compared_files);
  command->add_option("walks", options->both, "OLD and NEW: a file each")->expected(0, 2);
  command->add_option("--old", options->before, "recordings of the old walk (CSV), or its motion.json");
  command->add_option("--new", options->after, "recordings of the new walk (CSV)");
  add_layout_options(*command, options->read);
  command
      ->add_option("--model", options->model,
                   "whose coefficients are compared; auto: those of motion.json; of recordings with poses after every "
                   "cycle: sides, with final poses alone: full")
      ->check(example::one_of({"auto", "proportional", "simple", "full", "previous-command", "sides"}))
      ->capture_default_str();
  add_accuracy_options(*command, options->read);
  command->add_option("--certainty", options->certainty, "posterior probability from which on a statement is made")
      ->check(example::between(0.6, 0.9999))
      ->capture_default_str();
  auto* old_joints = command->add_option("--old-joints", options->joints_before,
                                         "logs of the joints in the old walk, as surefoot-walk --log writes them");
  auto* new_joints = command->add_option("--new-joints", options->joints_after, "the same of the new walk");
  old_joints->needs(new_joints);
  new_joints->needs(old_joints);
  command->add_option("--out", options->out, "folder for compare.json, made if needed");
  command->callback([options] { run(*options); });
}

}  // namespace calibrate_program

// concealed_all_at_once: a baseline of the blind benchmark that knows every effect of the library but does not search.
// Calibrates the nominal parameters, linearises all candidate effects at once, and names those that survive an L1
// penalty. Same command line and diagnosis.json as surefoot-diagnose.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "apps/diagnose/equations.hpp"
#include "apps/diagnose/known_effects.hpp"
#include "apps/diagnose/load_all.hpp"
#include "apps/diagnose/results.hpp"
#include "apps/diagnose/run.hpp"
#include "apps/diagnose/write_json.hpp"
#include "choose.hpp"
#include "prepare.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/text.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "surefoot/diagnose/verdict/evaluate.hpp"

namespace {

using namespace all_at_once;          // NOLINT(google-build-using-namespace): a program, not a header
using namespace surefoot::diagnosis;  // NOLINT(google-build-using-namespace)
using surefoot::Verdict;

// Parameters of the strongest survivors, fitted together in the simulation. What cannot be simulated goes, the weakest
// first.
Hypothesis fit_together(const Prepared& prepared, const LinearProblem& problem, std::vector<Survivor> survivors,
                        const Parallel& parallel) {
  FitProblem longer = prepared.setup.problem;
  longer.max_iterations = 40;
  for (;; survivors.pop_back()) {
    Hypothesis hypothesis = prepared.calibration.calibrated.hypothesis;
    for (const Survivor& survivor : survivors) {
      hypothesis.effects.push_back(problem.candidates[survivor.candidate]);
      hypothesis.values.push_back(survivor.values);
    }
    const Fit result = fit(prepared.setup.bound, hypothesis, longer, parallel);
    if (result.ok || survivors.empty()) return result.hypothesis;
  }
}

// Places of a fold's recordings among those of the training.
std::vector<std::vector<std::size_t>> places_of(const RecordingSplit& split) {
  std::vector<std::vector<std::size_t>> folds = split.folds;
  for (auto& fold : folds) {
    for (std::size_t& r : fold) {
      r = static_cast<std::size_t>(std::ranges::find(split.training, r) - split.training.begin());
    }
  }
  return folds;
}

surefoot::Diagnosis diagnose(const BindSimulator& bind, const surefoot::SimulatorInfo& info,
                             std::vector<surefoot::Recording> recordings, const RunContext& run) {
  Prepared prepared = prepare(bind, info, std::move(recordings), run);
  const EstimationSetup& setup = prepared.setup;
  surefoot::Diagnosis& diagnosis = prepared.diagnosis;
  const Hypothesis& calibrated = prepared.calibration.calibrated.hypothesis;

  const LinearProblem linear = linearise(prepared, candidate_effects(setup, prepared.calibration, run), run.parallel);
  Choice choice = choose(linear, places_of(setup.split), setup.problem.weighting.robust);
  const std::size_t survived = choice.survivors.size();
  choice.survivors.resize(std::min(survived, static_cast<std::size_t>(run.options.max_effects)));
  const Hypothesis chosen = fit_together(prepared, linear, choice.survivors, run.parallel);

  for (std::size_t e = calibrated.effects.size(); e < chosen.effects.size(); ++e) {
    diagnosis.effects.push_back(describe(setup.bound, chosen, e, nullptr));
  }
  diagnosis.parameters = calibrated_parameters(setup.bound, calibrated, {});
  diagnosis.augmented_parameters = calibrated_parameters(setup.bound, chosen, {});
  diagnosis.verdict = diagnosis.effects.empty() ? Verdict::parameters_only : Verdict::missing_physics;
  diagnosis.sentence = std::to_string(survived) + " of " + std::to_string(linear.candidates.size()) +
                       " effects survive a penalty of " + surefoot::in_digits(choice.penalty) +
                       " of the one that none survives; " + std::to_string(diagnosis.effects.size()) + " are named.";
  const FittedModels models{simulate_model(setup, prepared.calibration.nominal, run.parallel),
                            fitted_model(setup, calibrated, run.parallel), fitted_model(setup, chosen, run.parallel)};
  evaluate_errors(setup, models, diagnosis, run.seed);
  offer_forests(setup, models, diagnosis, run.parallel, run.seed);
  diagnosis.seconds = run.seconds();
  return diagnosis;
}

template <surefoot::Simulator S>
int run(const S& simulator, const diagnose_program::Layout& layout, const diagnose_program::CommandLine& line,
        const diagnose_program::ModelFile& model) {
  using namespace diagnose_program;
  LoadedRecordings loaded = load_all(line, layout);
  surefoot::DiagnoseOptions options;
  options.known = known_effects(model, surefoot::all_effects());
  options.held_out = test_names(line, loaded.recordings);
  options.held_out_share = line.test_share;
  options.effects = line.effects;
  options.max_effects = line.max_effects;
  prepare_folder(line.out);
  const surefoot::Threads threads(line.threads);
  const Parallel parallel = [&](std::size_t count, const std::function<void(std::size_t)>& job) {
    threads.run(count, job);
  };
  const BindSimulator bind = [&](std::vector<surefoot::Recording> some) {
    return bind_simulator(simulator, std::move(some));
  };
  check(options);
  surefoot::Diagnosis diagnosis =
      diagnose(bind, simulator.info(), std::move(loaded.recordings), {options, parallel, line.seed});
  diagnosis.remarks.insert(diagnosis.remarks.begin(), loaded.remarks.begin(), loaded.remarks.end());
  surefoot::write_file_atomically(line.out / "diagnosis.json", diagnosis_json(diagnosis));
  if (!line.quiet) {
    for (const surefoot::FoundEffect& effect : diagnosis.effects) {
      std::cout << effect.name << " at " << effect.attached_to << '\n';
    }
    std::cout << diagnosis.sentence << '\n';
  }
  return exit_done;
}

int diagnose_model(const diagnose_program::CommandLine& line) {
  using namespace diagnose_program;
  const ModelFile model = read_model_file(line.model);
  const Layout layout = layout_of(model);
  if (layout.ode) return run(OdeModel(model), layout, line, model);
  return run(MapModel(model), layout, line, model);
}

}  // namespace

int main(int argc, char** argv) { return diagnose_program::guarded(argc, argv, true, diagnose_model); }

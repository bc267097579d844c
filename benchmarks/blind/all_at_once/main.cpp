// concealed_all_at_once: a baseline for the concealed proof that knows every effect of the library but does not search.
// Calibrates the nominal parameters, linearises all candidate effects at once, and names those that survive an L1
// penalty. Same command line and diagnosis.json as surefoot-diagnose.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "choose.hpp"
#include "apps/diagnose/equations.hpp"
#include "apps/diagnose/known_effects.hpp"
#include "apps/diagnose/load_all.hpp"
#include "apps/diagnose/results.hpp"
#include "apps/diagnose/run.hpp"
#include "apps/diagnose/write_json.hpp"
#include "prepare.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "surefoot/diagnose/verdict/evaluate.hpp"

using namespace surefoot::diagnosis;

namespace {

using namespace all_at_once;  // NOLINT(google-build-using-namespace): a program, not a header
using surefoot::Verdict;

// Numbers of the strongest survivors, fitted together in the simulation. What cannot be simulated goes, the weakest
// first.
surefoot::Fit fit_together(const surefoot::Investigation& investigation, const LinearProblem& problem,
                           std::vector<Survivor> survivors, const surefoot::Parallel& parallel) {
  surefoot::FitProblem longer = investigation.problem.fit;
  longer.max_iterations = 40;
  for (;; survivors.pop_back()) {
    surefoot::Hypothesis hypothesis = investigation.selection.nominal.hypothesis;
    for (const Survivor& survivor : survivors) {
      hypothesis.effects.push_back(problem.candidates[survivor.candidate]);
      hypothesis.values.push_back(survivor.values);
    }
    surefoot::Fit result = fit(investigation.bound, hypothesis, longer, parallel);
    if (result.ok || survivors.empty()) return result;
  }
}

// Places of a fold's recordings among those of the training.
std::vector<std::vector<std::size_t>> places_of(const surefoot::RecordingSplit& split) {
  std::vector<std::vector<std::size_t>> folds = split.folds;
  for (auto& fold : folds) {
    for (std::size_t& r : fold) {
      r = static_cast<std::size_t>(std::ranges::find(split.training, r) - split.training.begin());
    }
  }
  return folds;
}

surefoot::Diagnosis diagnose(const MakeRig& make, const surefoot::SimulatorInfo& info,
                             std::vector<surefoot::Recording> recordings, const surefoot::DiagnoseOptions& options,
                             const surefoot::Parallel& parallel, std::uint64_t seed) {
  const auto began = std::chrono::steady_clock::now();
  surefoot::Investigation investigation = prepare(make, info, std::move(recordings), options, parallel, seed);
  const surefoot::BoundSimulator& bound = investigation.bound;
  const surefoot::FitProblem& problem = investigation.problem.fit;
  surefoot::Diagnosis& diagnosis = investigation.diagnosis;
  const surefoot::Hypothesis& calibrated = investigation.selection.nominal.hypothesis;

  const LinearProblem linear = linearise(investigation, candidates(investigation, options, parallel), parallel);
  Choice choice = choose(linear, places_of(investigation.split), problem.weighting.robust);
  const std::size_t survived = choice.survivors.size();
  choice.survivors.resize(std::min(survived, static_cast<std::size_t>(options.max_effects)));
  const surefoot::Hypothesis chosen = fit_together(investigation, linear, choice.survivors, parallel).hypothesis;

  for (std::size_t e = calibrated.effects.size(); e < chosen.effects.size(); ++e) {
    diagnosis.effects.push_back(surefoot::diagnosis::describe(bound, chosen, e, nullptr));
  }
  diagnosis.parameters = surefoot::diagnosis::calibrated_parameters(bound, calibrated, {});
  diagnosis.augmented_parameters = surefoot::diagnosis::calibrated_parameters(bound, chosen, {});
  diagnosis.verdict = diagnosis.effects.empty() ? Verdict::parameters_only : Verdict::missing_physics;
  diagnosis.sentence = std::to_string(survived) + " of " + std::to_string(linear.candidates.size()) +
                       " effects survive a penalty of " + surefoot::in_digits(choice.penalty) +
                       " of the one that none survives; " + std::to_string(diagnosis.effects.size()) + " are named.";
  surefoot::diagnosis::prove(investigation, calibrated, chosen, parallel, seed);
  diagnosis.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return diagnosis;
}

template <surefoot::Simulator S>
int run(const S& simulator, const diagnose_program::Layout& layout, const diagnose_program::CommandLine& line,
        const diagnose_program::ModelFile& model) {
  using namespace diagnose_program;
  LoadedRecordings loaded = load_all(line, layout);
  surefoot::DiagnoseOptions options;
  options.known = known_effects(model, surefoot::all_effects());
  options.test = test_names(line, loaded.recordings);
  options.test_share = line.test_share;
  options.effects = line.effects;
  options.max_effects = line.max_effects;
  prepare_folder(line.out);
  const surefoot::Threads threads(line.threads);
  const surefoot::Parallel parallel = [&](std::size_t count, const std::function<void(std::size_t)>& job) {
    threads.run(count, job);
  };
  const MakeRig make = [&](std::vector<surefoot::Recording> some) { return bind_simulator(simulator, std::move(some)); };
  surefoot::Diagnosis diagnosis =
      diagnose(make, simulator.info(), std::move(loaded.recordings), options, parallel, line.seed);
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

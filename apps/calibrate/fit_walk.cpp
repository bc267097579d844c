#include "fit_walk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outlier_sentences.hpp"
#include "surefoot/motion/calibrate.hpp"

namespace calibrate_program {
namespace {

using surefoot::FitMethod;
using surefoot::MotionError;
using surefoot::PredictorOptions;
using surefoot::WalkSequence;
using Sequences = std::span<const WalkSequence>;

constexpr double hour = std::numbers::pi / 6;  // of a clock [rad]

EvaluatedModel evaluated(const surefoot::ModelEvaluation& score) {
  return {.model = score.name,
          .parameters = score.parameters,
          .position = score.position,
          .position_error = score.position_error,
          .heading = score.heading,
          .chosen = score.chosen};
}

std::vector<EvaluatedModel> compare(Sequences sequences, const PredictorOptions& options, const FitSettings& settings,
                                    const StoppableThreads& executor) {
  surefoot::CompareOptions compare;
  compare.predictor = options;
  std::vector<surefoot::AnyMotionModel> models;
  for (const ModelKind kind : all_models) models.push_back(default_model(kind));
  std::vector<EvaluatedModel> result;
  for (const surefoot::ModelEvaluation& score : surefoot::compare_models(
           std::span<const surefoot::AnyMotionModel>(models), sequences, compare, executor, settings.seed)) {
    result.push_back(evaluated(score));
  }
  return result;
}

surefoot::AnyMotionModel published_model(const surefoot::AnyMotionModel& start, Sequences sequences,
                                         const PredictorOptions& options, const FitSettings& settings,
                                         const StoppableThreads& executor) {
  return surefoot::published_fit(start, sequences, options.published, executor, settings.seed, executor.token).model;
}

/// Errors of all models on held-out sequences.
std::vector<EvaluatedModel> evaluate_on_test(Sequences sequences, Sequences test, const PredictorOptions& options,
                                             const FitSettings& settings, const StoppableThreads& executor) {
  std::vector<EvaluatedModel> models{evaluated(surefoot::evaluate_commands(test))};
  for (const ModelKind kind : all_models) {
    const surefoot::AnyMotionModel start = default_model(kind);
    const surefoot::AnyMotionModel model = options.method == FitMethod::published
                                               ? published_model(start, sequences, options, settings, executor)
                                               : surefoot::calibrate(sequences, options.calibration, start).model;
    models.push_back(evaluated(surefoot::evaluate_on(model, test)));
  }
  return models;
}

/// Fits the model of the kind of the file, and its noise.
void fit_model_and_noise(Sequences sequences, const PredictorOptions& options, const FitSettings& settings,
                         const StoppableThreads& executor, FittedWalk& fitted) {
  constexpr double determined = 0.5;  // [standard deviations of the prior] that the standard error falls to
  const bool published = options.method == FitMethod::published;
  MotionFile& file = fitted.file;
  const surefoot::AnyMotionModel start = default_model(file.kind);
  settings.progress("fitting");
  const auto calibration = surefoot::calibrate(sequences, options.calibration, start);
  const surefoot::AnyMotionModel by_errors = published_model(start, sequences, options, settings, executor);
  settings.progress("choosing the noise");
  surefoot::NoiseChoiceOptions noise;
  noise.fit = {.accuracy = options.calibration.model.accuracy, .scale = options.calibration.noise_scale};
  fitted.noise = surefoot::choose_noise(published ? by_errors : calibration.model, sequences, noise, executor);
  const auto fit = surefoot::fit_model(sequences, fitted.noise.noise(), options.calibration.model, calibration.model);
  file.parameters = (published ? by_errors : fit.model).parameters();
  file.model = embedded(file.kind, file.parameters);
  file.covariance = fit.covariance;
  fitted.by_other_method = (published ? fit.model : by_errors).parameters();
  const Eigen::VectorXd prior = options.calibration.model.prior * start.parameter_box().width();
  for (Eigen::Index i = 0; i < prior.size(); ++i) {
    fitted.determined.push_back(std::sqrt(fit.covariance(i, i)) < determined * prior[i]);
  }
}

}  // namespace

bool headings_of_clock(Sequences sequences) {
  std::size_t measured = 0;
  for (const WalkSequence& sequence : sequences) {
    for (const double heading : sequence.poses.row(2)) {
      if (!std::isfinite(heading)) continue;
      ++measured;
      if (std::abs(surefoot::wrap_angle(heading - hour * std::round(heading / hour))) > 1e-3) return false;
    }
  }
  return measured >= 3;
}

surefoot::Vec<3> command_scale(Sequences sequences) {
  surefoot::Vec<3> scale = surefoot::Vec<3>::Zero();
  for (const WalkSequence& sequence : sequences) {
    scale = scale.cwiseMax(sequence.commands.cwiseAbs().rowwise().maxCoeff());
  }
  if (scale[0] == 0) scale[0] = scale[1] > 0 ? scale[1] : 0.08;
  if (scale[1] == 0) scale[1] = scale[0];
  if (scale[2] == 0) scale[2] = 0.4;
  return scale;
}

std::size_t count_readings(Sequences sequences) {
  std::size_t count = 0;
  for (const WalkSequence& sequence : sequences) {
    count += static_cast<std::size_t>(sequence.poses.array().isFinite().count());
  }
  return count;
}

PredictorOptions predictor_options(Sequences sequences, const FitSettings& settings) {
  if (sequences.size() < 2) {
    throw MotionError(
        "only 1 sequence has a final position, but at least 2 are needed to evaluate a model on one that it "
        "was not fitted to; walk more");
  }
  PredictorOptions options;
  options.method = settings.method;
  const double tolerance = settings.heading_tolerance.value_or(headings_of_clock(sequences) ? hour / 2 : 0);
  options.calibration.model.accuracy = {
      .position = settings.position_accuracy, .heading = settings.heading_accuracy, .heading_tolerance = tolerance};
  options.calibration.noise_scale = command_scale(sequences);
  options.calibration.first_noise = options.calibration.noise_scale / 8;
  if (settings.heading_tolerance) options.published.heading_tolerance = *settings.heading_tolerance;
  return options;
}

FittedWalk fit_walk(Sequences sequences, Sequences test, const FitSettings& settings,
                    const StoppableThreads& executor) {
  const PredictorOptions options = predictor_options(sequences, settings);
  FittedWalk fitted;
  fitted.headings_of_clock = !settings.heading_tolerance && headings_of_clock(sequences);
  MotionFile& file = fitted.file;
  settings.progress("comparing the models");
  file.heldout = compare(sequences, options, settings, executor);
  const auto best = std::ranges::find(file.heldout, true, &EvaluatedModel::chosen);
  const auto index = std::max<std::ptrdiff_t>(best - file.heldout.begin(), 1) - 1;
  file.kind = settings.kind.value_or(all_models[static_cast<std::size_t>(index)]);
  if (settings.kind) {  // not the one that predicts best, but the one that was asked for
    for (std::size_t i = 0; i < file.heldout.size(); ++i) {
      file.heldout[i].chosen = i == static_cast<std::size_t>(file.kind) + 1;
    }
  }
  if (!test.empty()) {
    settings.progress("evaluating the models on held-out sequences");
    file.test = evaluate_on_test(sequences, test, options, settings, executor);
  }
  fit_model_and_noise(sequences, options, settings, executor, fitted);
  for (EvaluatedModel& model : file.test) model.chosen = model.parameters == static_cast<int>(file.parameters.size());
  fitted.outliers = outlier_sentences(sequences, options.calibration);
  file.noise = fitted.noise.noise();
  file.noise_shape_known = fitted.noise.shape_known;
  file.accuracy = options.calibration.model.accuracy;
  file.method = options.method == FitMethod::published ? "published" : "likelihood";
  file.sequences = sequences.size();
  file.readings = count_readings(sequences);
  file.seed = settings.seed;
  return fitted;
}

}  // namespace calibrate_program

#include "fit_walk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "absurd_sequences.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/fit/published_fit.hpp"

namespace calibrate_program {
namespace {

using surefoot::FitMethod;
using surefoot::MotionError;
using surefoot::PredictorOptions;
using surefoot::WalkSequence;
using Sequences = std::span<const WalkSequence>;

constexpr double hour = std::numbers::pi / 6;  // of a clock [rad]

std::vector<JudgedModel> compare(Sequences sequences, const PredictorOptions& options, const FitSettings& settings,
                                 const StoppableThreads& executor) {
  surefoot::CompareOptions compare;
  compare.predictor = options;
  const auto scores = surefoot::compare_models<surefoot::ProportionalCorrection, surefoot::SimpleLinearCorrection,
                                               surefoot::FullLinearCorrection, surefoot::PreviousCommandCorrection>(
      sequences, compare, executor, settings.seed);
  std::vector<JudgedModel> judged;
  for (const surefoot::ModelScore& score : scores) {
    judged.push_back({.model = score.name,
                      .parameters = score.parameters,
                      .position = score.position,
                      .position_error = score.position_error,
                      .heading = score.heading,
                      .chosen = score.chosen});
  }
  return judged;
}

template <surefoot::MotionModel M>
JudgedModel judge(const M& model, std::string name, int parameters, Sequences test) {
  const auto count = static_cast<Eigen::Index>(test.size());
  surefoot::detail::HeldoutErrors errors{Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    surefoot::detail::judge_final_pose(model, test[static_cast<std::size_t>(i)], i, errors);
  }
  const auto score = surefoot::detail::score(std::move(name), parameters, errors);
  return {.model = score.name,
          .parameters = parameters,
          .position = score.position,
          .position_error = score.position_error,
          .heading = score.heading};
}

template <surefoot::MotionModel M>
M published_model(Sequences sequences, const PredictorOptions& options, const FitSettings& settings,
                  const StoppableThreads& executor) {
  return surefoot::published_fit<M>(sequences, options.published, executor, settings.seed, executor.token).model;
}

/// Errors of all models on sequences that were kept aside.
std::vector<JudgedModel> judge_on_test(Sequences sequences, Sequences test, const PredictorOptions& options,
                                       const FitSettings& settings, const StoppableThreads& executor) {
  std::vector<JudgedModel> judged{judge(surefoot::detail::AsOrdered{}, "commands as they are", 0, test)};
  for (const ModelKind kind : all_models) {
    with_model(kind, [&]<surefoot::MotionModel M>() {
      const M model = options.method == FitMethod::published
                          ? published_model<M>(sequences, options, settings, executor)
                          : surefoot::calibrate<M>(sequences, options.calibration).model;
      judged.push_back(judge(model, surefoot::model_name<M>(), M::parameter_count, test));
    });
  }
  return judged;
}

template <surefoot::MotionModel M>
void fit_as(Sequences sequences, const PredictorOptions& options, const FitSettings& settings,
            const StoppableThreads& executor, FittedWalk& fitted) {
  const bool published = options.method == FitMethod::published;
  settings.progress("fitting");
  const auto calibration = surefoot::calibrate<M>(sequences, options.calibration);
  const M by_errors = published_model<M>(sequences, options, settings, executor);
  const M& first = published ? by_errors : calibration.model;
  settings.progress("choosing the noise");
  surefoot::NoiseChoiceOptions noise;
  noise.fit = {.accuracy = options.calibration.model.accuracy, .scale = options.calibration.noise_scale};
  fitted.noise = surefoot::choose_noise(first, sequences, noise, executor);
  const auto fit = surefoot::fit_model(sequences, fitted.noise.noise(), options.calibration.model, calibration.model);
  const M model = published ? by_errors : fit.model;
  MotionFile& file = fitted.file;
  file.model = embedded(model);
  file.parameters = model.parameters();
  file.covariance = fit.covariance;
  fitted.by_other_method = (published ? fit.model : by_errors).parameters();
  const surefoot::Vec<M::parameter_count> prior =
      options.calibration.model.prior * surefoot::parameter_box<M>().width();
  for (Eigen::Index i = 0; i < M::parameter_count; ++i) {
    fitted.determined.push_back(std::sqrt(fit.covariance(i, i)) < 0.5 * prior[i]);
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
        "only 1 sequence has a final position, but at least 2 are needed to judge a model on one that it "
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
  const auto best = std::ranges::find(file.heldout, true, &JudgedModel::chosen);
  const auto index = std::max<std::ptrdiff_t>(best - file.heldout.begin(), 1) - 1;
  file.kind = settings.kind.value_or(all_models[static_cast<std::size_t>(index)]);
  if (settings.kind) {  // not the one that predicts best, but the one that was asked for
    for (std::size_t i = 0; i < file.heldout.size(); ++i) {
      file.heldout[i].chosen = i == static_cast<std::size_t>(file.kind) + 1;
    }
  }
  if (!test.empty()) {
    settings.progress("judging on the sequences kept aside");
    file.test = judge_on_test(sequences, test, options, settings, executor);
  }
  with_model(file.kind, [&]<surefoot::MotionModel M>() { fit_as<M>(sequences, options, settings, executor, fitted); });
  for (JudgedModel& judged : file.test) {
    judged.chosen = judged.parameters == static_cast<int>(file.parameters.size());
  }
  fitted.absurd = absurd_sequences(sequences, options.calibration);
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

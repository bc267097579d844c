#include "fit_report.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "../common/printed.hpp"

namespace calibrate_program {
namespace {

constexpr double degree = std::numbers::pi / 180;

std::string coefficients(const FittedWalk& fitted) {
  const MotionFile& file = fitted.file;
  const bool published = file.method == "published";
  std::string text;
  text += example::printed("\n%-24s %12s %12s %12s\n", "coefficient", "value", "std. error",
                           published ? "likelihood" : "published");
  Eigen::Index i = 0;
  for (const surefoot::ModelParameter& info : default_model(file.kind).parameter_info()) {
    const std::string name = std::string(info.name) + (info.unit == "1" ? "" : " [" + std::string(info.unit) + "]");
    text +=
        example::printed("%-24s %12.4g %12.2g %12.4g%s\n", name.c_str(), file.parameters[i],
                         std::sqrt(file.covariance(i, i)), fitted.by_other_method[i],
                         fitted.determined[static_cast<std::size_t>(i)] ? "" : "  not determined by these commands");
    ++i;
  }
  return text;
}

std::string noise(const FittedWalk& fitted) {
  const surefoot::MotionNoise& noise = fitted.file.noise;
  std::string text = "\nNoise of a cycle (standard deviations of forward [m], left [m], turn [degrees]):\n  ";
  const auto term = [&](const surefoot::Vec<3>& v) {
    const surefoot::Vec<3> shown = (v.array() > 1e-7).select(v, 0.0);
    text += example::printed("%.3g, %.3g, %.3g", shown[0], shown[1], shown[2] / degree);
  };
  const auto& chosen = fitted.noise.candidates[fitted.noise.chosen];
  switch (chosen.growth) {
    case surefoot::NoiseGrowth::constant:
      term(noise.constant);
      text += " whatever the command.\n";
      break;
    case surefoot::NoiseGrowth::with_speed:
      term(noise.per_speed);
      text += " at full speed, proportional to the speed.\n";
      break;
    case surefoot::NoiseGrowth::with_speed_and_acceleration:
      term(noise.constant);
      text += ",\n  at full speed ";
      term(noise.per_speed);
      text += " more, at full acceleration ";
      term(noise.per_acceleration);
      text += " more.\n";
  }
  if (fitted.noise.shape_known) {
    const auto shape = surefoot::name_of(noise.shape);
    text += example::printed("Its shape is %.*s.\n", static_cast<int>(shape.size()), shape.data());
  } else {
    text += "Its shape (uniform or gaussian) cannot be told from final poses: they add up too many cycles.\n";
  }
  bool ahead = false;  // of a kind of noise that grows differently
  for (const auto& candidate : fitted.noise.candidates) {
    const bool other = candidate.growth != chosen.growth && candidate.shape == chosen.shape;
    ahead = ahead || (other && candidate.behind <= 2 * candidate.behind_error);
  }
  if (ahead) text += "Whether it grows with speed or acceleration these sequences cannot tell; the simplest is kept.\n";
  return text;
}

}  // namespace

std::string evaluation_table(const std::vector<EvaluatedModel>& models) {
  std::string text;
  text += example::printed("%-34s %12s %22s %14s\n", "model", "coefficients", "final position [m]", "heading [deg]");
  for (const EvaluatedModel& model : models) {
    char heading[32] = "-", error[32] = "";
    if (std::isfinite(model.heading)) std::snprintf(heading, sizeof heading, "%.1f", model.heading / degree);
    if (std::isfinite(model.position_error)) std::snprintf(error, sizeof error, " +- %.3f", model.position_error);
    text += example::printed("%-34.34s %12d %13.3f%s %14s%s\n", model.model.c_str(), model.parameters, model.position,
                             error, heading, model.chosen ? "  <- chosen" : "");
  }
  return text;
}

std::string fit_report(const FittedWalk& fitted) {
  const MotionFile& file = fitted.file;
  std::string text;
  text += example::printed("%zu sequences. Root mean square errors on those held out of the fit:\n\n", file.sequences);
  text += evaluation_table(file.heldout);
  if (file.heldout.front().chosen) {
    text += "No model predicts better than the commands as they are.\n";
  }
  if (!file.test.empty()) {
    text += "\nErrors on the held-out sequences, fitted to all others:\n\n" + evaluation_table(file.test);
  }
  const auto name = name_of(file.kind);
  text += example::printed("\nFitted: the model %.*s, by the %s.\n", static_cast<int>(name.size()), name.data(),
                           file.method == "published" ? "published fitness (errors of final poses)" : "likelihood");
  if (fitted.headings_of_clock) {
    text += "All headings are whole hours of a clock: errors of up to 15 degrees count as none.\n";
  }
  text += coefficients(fitted);
  text += noise(fitted);
  for (const std::string& sentence : fitted.outliers) text += "warning: " + sentence + ".\n";
  return text;
}

}  // namespace calibrate_program

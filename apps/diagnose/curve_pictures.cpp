// Pictures of the test recordings for the report.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "chart.hpp"
#include "report.hpp"

namespace diagnose_program {
namespace {

constexpr std::size_t most_pictures = 12;

bool empty(const Eigen::MatrixXd& values) { return values.size() == 0; }

constexpr double turn = 2 * std::numbers::pi;

// An angle that was measured up to full turns.
bool is_wrapped(const std::string& unit, const Eigen::VectorXd& measured) {
  return unit == "rad" && std::ranges::none_of(measured, [](double value) { return std::abs(value) > 3.1416; });
}

Chart chart_of(const surefoot::Diagnosis& diagnosis, const surefoot::SimulatorInfo& info, const surefoot::Curve& curve,
               Eigen::Index output) {
  const auto& channel = info.outputs[static_cast<std::size_t>(output)];
  const std::string unit = channel.unit.empty() || channel.unit == "1" ? "" : " [" + channel.unit + "]";
  const bool effects = !diagnosis.effects.empty() && !empty(curve.after);
  Eigen::VectorXd measured = curve.measured.row(output);
  const bool wrapped = is_wrapped(channel.unit, measured);
  const Eigen::MatrixXd& best = effects ? curve.after : curve.before;
  for (Eigen::Index row = 0; wrapped && !empty(best) && row < measured.size(); ++row) {
    measured[row] += turn * std::round((best(output, row) - measured[row]) / turn);
  }
  Chart chart{curve.recording + ", " + channel.name,
              info.kind == surefoot::SimulatorKind::ode ? "time [s]" : "step",
              curve.time,
              {},
              {}};
  Panel values{channel.name + unit, 150, {}}, errors{"error: simulated - measured" + unit, 80, {}};
  const auto add = [&](const char* label, const char* style, const Eigen::MatrixXd& simulated, bool error) {
    if (empty(simulated)) return;
    values.series.push_back({label, style, simulated.row(output)});
    if (!error) return;
    Eigen::VectorXd off = simulated.row(output).transpose() - measured;
    if (wrapped) off = off.unaryExpr([](double value) { return std::remainder(value, turn); });
    errors.series.push_back({"", style, off});
  };
  values.series.push_back({"measured", "measured", measured});  // first: the simulations are drawn over it
  add("nominal", "nominal", curve.nominal, false);
  add("calibrated", "before", curve.before, true);
  if (effects) add("with effects", "after", curve.after, true);
  chart.panels = {values, errors};
  for (const auto& one : diagnosis.intervals) {
    if (one.recording == curve.recording) chart.highlighted.push_back({one.from, one.to});
  }
  return chart;
}

}  // namespace

std::vector<Picture> curve_pictures(const surefoot::Diagnosis& diagnosis, const surefoot::SimulatorInfo& info) {
  std::vector<Picture> pictures;
  for (const auto& curve : diagnosis.curves) {
    const Eigen::Index outputs = std::min(curve.measured.rows(), static_cast<Eigen::Index>(info.outputs.size()));
    for (Eigen::Index output = 0; output < outputs && pictures.size() < most_pictures; ++output) {
      const bool measured =
          curve.measured.row(output).unaryExpr([](double v) { return std::isfinite(v) ? 1.0 : 0.0; }).sum() > 0;
      if (!measured || curve.time.size() < 2) continue;
      pictures.push_back({"curve_" + std::to_string(pictures.size() + 1),
                          chart_svg(chart_of(diagnosis, info, curve, output)), curve.recording});
    }
  }
  return pictures;
}

}  // namespace diagnose_program

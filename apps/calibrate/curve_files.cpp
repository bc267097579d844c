#include "curve_files.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../common/files.hpp"
#include "../common/gnuplot.hpp"

namespace calibrate_program {
namespace {

constexpr std::array<const char*, 4> colours{"#999999", "#009e73", "#0072b2", "#d55e00"};

std::string csv(const std::vector<CountedCurve>& curves) {
  std::ostringstream out;
  out << "model,sequences,position_m,position_half_width_m\n";
  for (const CountedCurve& one : curves) {
    for (std::size_t i = 0; i < one.curve.counts.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      out << file_name_of(one.kind) << ',' << one.curve.counts[i] << ',' << one.curve.position[at] << ','
          << one.curve.position_half_width[at] << '\n';
    }
  }
  return out.str();
}

template <class Matrix>
std::vector<double> row_of(const Matrix& matrix, Eigen::Index row) {
  const Eigen::RowVectorXd values = matrix.row(row);
  return {values.begin(), values.end()};
}

nlohmann::ordered_json coefficients(const CountedCurve& one) {
  auto list = nlohmann::ordered_json::array();
  Eigen::Index i = 0;
  for (const surefoot::ModelParameter& info : default_model(one.kind).parameter_info()) {
    list.push_back({{"name", info.name},
                    {"unit", info.unit},
                    {"mean", row_of(one.curve.coefficients, i)},
                    {"standard_deviation", row_of(one.curve.coefficients_deviation, i)}});
    ++i;
  }
  return list;
}

std::string json(const std::vector<CountedCurve>& curves, double as_commanded,
                 const surefoot::LearningCurveOptions& options) {
  nlohmann::ordered_json json{{"schema", "surefoot.learning_curve/1"},
                              {"validation", options.validation},
                              {"repetitions", options.repetitions},
                              {"sequences", curves[0].curve.counts},
                              {"as_ordered_m", as_commanded},
                              {"advice", which_model(curves)},
                              {"models", nlohmann::ordered_json::array()}};
  for (const CountedCurve& one : curves) {
    const Eigen::RowVectorXd position = one.curve.position.matrix().transpose();
    const Eigen::RowVectorXd half_width = one.curve.position_half_width.matrix().transpose();
    json["models"].push_back({{"model", file_name_of(one.kind)},
                              {"position_m", row_of(position, 0)},
                              {"position_half_width_m", row_of(half_width, 0)},
                              {"limit_m", one.more.limit},
                              {"more_sequences", one.more.worthwhile},
                              {"coefficients", coefficients(one)}});
  }
  return json.dump(1) + "\n";
}

void draw_curve(const std::filesystem::path& base, const std::vector<CountedCurve>& curves, double as_commanded) {
  std::ostringstream data, commands;
  double most = as_commanded, least = as_commanded;
  for (const CountedCurve& one : curves) {
    for (std::size_t i = 0; i < one.curve.counts.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      data << one.curve.counts[i] << ' ' << one.curve.position[at] << ' ' << one.curve.position_half_width[at] << '\n';
    }
    data << "\n\n";
    least = std::min(least, one.curve.position.minCoeff());
  }
  most *= 1.35;
  commands << "set xlabel 'sequences fitted to'\nset ylabel 'error of the final position [m]'\n"
              "set title 'Held-out error by the number of sequences (bands: 95 %)'\n"
              "set grid lc rgb '#e6e6e6' lt 1\nset key top right\nset logscale x\n"
              "set xtics (1, 2, 3, 5, 7, 10, 15, 20, 30, 40, 60, 80, 120, 200, 400)\nset xrange ["
           << curves[0].curve.counts.front() << ':' << curves[0].curve.counts.back() << "]\nset yrange [" << 0.6 * least
           << ':' << most << "]\nplot " << as_commanded
           << " with lines dt 2 lw 1.5 lc rgb '#000000' title 'commands as they are'";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const char* colour = colours[static_cast<std::size_t>(curves[i].kind)];
    commands << ", data index " << i
             << " using 1:($2-$3):($2+$3) with filledcurves fs transparent solid 0.25 noborder lc rgb '" << colour
             << "' notitle, '' index " << i << " using 1:2 with linespoints pt 7 ps 0.5 lw 2 lc rgb '" << colour
             << "' title '" << curves[i].curve.model << " (" << curves[i].curve.coefficients.rows() << ")'";
  }
  example::draw(base, commands.str() + "\n", data.str(), 820, 520);
}

/// Twelve panels, one per coefficient of the full model.
void draw_coefficients(const std::filesystem::path& base, const surefoot::LearningCurve& curve) {
  std::ostringstream data, commands;
  commands << "set multiplot layout 3,4 title 'Coefficients of the full model by the number of sequences (band: "
              "standard deviation over the splits)'\nset grid lc rgb '#e6e6e6' lt 1\nset key off\nset logscale x\n"
              "set xtics (1, 2, 5, 10, 20, 50, 100, 200)\nset xrange ["
           << std::max<std::size_t>(curve.counts.front(), 1) << ':' << curve.counts.back() << "]\n";
  Eigen::Index i = 0;
  for (const surefoot::ModelParameter& info : surefoot::FullLinearCorrection::parameter_info()) {
    for (std::size_t k = 0; k < curve.counts.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      data << curve.counts[k] << ' ' << curve.coefficients(i, at) << ' ' << curve.coefficients_deviation(i, at) << '\n';
    }
    data << "\n\n";
    const bool diagonal = i % 5 == 1;
    commands
        << "set title '" << info.name << (info.unit == "1" ? "" : " [" + std::string(info.unit) + "]")
        << "' offset 0,-0.6\n"
        << "plot " << (diagonal ? 1 : 0) << " with lines dt 2 lc rgb '#888888', data index " << i
        << " using 1:($2-$3):($2+$3) with filledcurves fs transparent solid 0.25 noborder lc rgb '#0072b2', '' index "
        << i << " using 1:2 with lines lw 2 lc rgb '#0072b2'\n";
    ++i;
  }
  example::draw(base, commands.str() + "unset multiplot\n", data.str(), 1200, 760);
}

}  // namespace

std::string which_model(const std::vector<CountedCurve>& curves) {
  const CountedCurve* best = &curves.front();
  for (const CountedCurve& one : curves) {
    const auto last = one.curve.position.size() - 1;
    // A larger model must be ahead by more than the curve is uncertain.
    const double ahead = best->curve.position[last] - one.curve.position[last];
    if (ahead > 0.5 * one.curve.position_half_width[last]) best = &one;
  }
  char text[400];
  const auto name = name_of(best->kind);
  std::snprintf(text, sizeof text, "With these %zu sequences use the model %.*s (%.3f m)", best->more.have,
                static_cast<int>(name.size()), name.data(), best->more.now);
  std::string sentence = text;
  if (best->more.worthwhile == 0) {
    std::snprintf(text, sizeof text, "; more sequences would hardly improve it, its limit is about %.3f m.",
                  best->more.limit);
  } else {
    std::snprintf(text, sizeof text,
                  "; about %zu more are worth walking, they bring it within 5 %% of its limit, %.3f m.",
                  best->more.worthwhile, best->more.limit);
  }
  return sentence + text;
}

void write_curve_files(const std::filesystem::path& folder, const std::vector<CountedCurve>& curves,
                       double as_commanded, const surefoot::LearningCurveOptions& options) {
  draw_curve(folder / "curve", curves, as_commanded);
  for (const CountedCurve& one : curves) {
    if (one.kind == ModelKind::full) draw_coefficients(folder / "coefficients", one.curve);
  }
  example::write_text(folder / "curve.csv", csv(curves));
  example::write_text(folder / "curve.json", json(curves, as_commanded, options));
}

}  // namespace calibrate_program

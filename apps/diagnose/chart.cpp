#include "chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "html.hpp"
#include "wording.hpp"

namespace diagnose_program {
namespace {

// Pixels of the picture at its own size.
constexpr double width = 480, left = 62, right = 12, title_height = 22, gap = 10, axis_height = 40, legend_height = 22;
constexpr double plot_width = width - left - right;

constexpr const char* style =
    "text{font:13px system-ui,-apple-system,'Segoe UI',Roboto,'DejaVu Sans',sans-serif;fill:#444}"
    ".title{font-weight:600;fill:#222}"
    ".frame{fill:none;stroke:#c8c8c8}.grid{stroke:#ececec}.mark{fill:#ffe9b8}"
    "path{fill:none;stroke-width:1.6;stroke-linejoin:round}"
    ".measured{stroke:#bdbdbd;stroke-width:4.5}.nominal{stroke:#8f8f8f;stroke-width:1.2;stroke-dasharray:4 "
    "3}.before{stroke:#d9731a}.after{stroke:#1767b5}"
    "circle.measured{fill:#8a8a8a;stroke:none}circle.nominal{fill:#a9a9a9;stroke:none}"
    "circle.before{fill:#d9731a;stroke:none}circle.after{fill:#1767b5;stroke:none}";

struct Range {
  double low = 0, high = 1;
};

struct Axis {
  Range range;
  double at_low = 0, at_high = 1;  // pixels

  double operator()(double value) const {
    return at_low + (value - range.low) / (range.high - range.low) * (at_high - at_low);
  }
};

std::string pixels(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.1f", value);
  return buffer.data();
}

Range widened(Range range, double share) {
  if (!(range.high >= range.low)) return {0, 1};  // nothing to draw
  double margin = share * (range.high - range.low);
  if (!(margin > 0)) margin = std::max(1e-9, 0.1 * std::abs(range.low));
  return {range.low - margin, range.high + margin};
}

Eigen::Index count_finite(const Eigen::VectorXd& values) {
  return std::ranges::count_if(values, [](double value) { return std::isfinite(value); });
}

// Points without neighbours, which a curve would not show.
bool isolated(const Eigen::VectorXd& values) {
  Eigen::Index alone = 0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const bool before = i > 0 && std::isfinite(values[i - 1]);
    const bool after = i + 1 < values.size() && std::isfinite(values[i + 1]);
    if (std::isfinite(values[i]) && !before && !after) ++alone;
  }
  return 2 * alone > count_finite(values);
}

// A simulation that leaves the measured range far behind would flatten everything else: it is cut at three times it.
Range y_range(const Panel& panel) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Range all{infinity, -infinity}, kept{infinity, -infinity};
  bool often = false;  // measured in most rows
  for (const Series& series : panel.series) {
    if (series.style == "measured") often = 2 * count_finite(series.values) > series.values.size();
    for (const double value : series.values) {
      if (!std::isfinite(value)) continue;
      all = {std::min(all.low, value), std::max(all.high, value)};
      if (series.style == "measured") kept = {std::min(kept.low, value), std::max(kept.high, value)};
    }
  }
  if (kept.high > kept.low && often) {
    const double reach = kept.high - kept.low;
    all = {std::max(all.low, kept.low - reach), std::min(all.high, kept.high + reach)};
  }
  return widened(all, 0.06);
}

// Round numbers, about `count` of them.
std::vector<double> ticks(const Range& range, int count) {
  const double rough = (range.high - range.low) / count;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double step = rough / power < 1.5   ? power
                      : rough / power < 3.5 ? 2 * power
                      : rough / power < 7.5 ? 5 * power
                                            : 10 * power;
  std::vector<double> result;
  for (double tick = std::ceil(range.low / step) * step; tick <= range.high + 1e-9 * step && result.size() < 20;
       tick += step) {
    result.push_back(std::abs(tick) < 1e-9 * step ? 0 : tick);
  }
  return result;
}

std::string text(double x, double y, const std::string& anchor, const std::string& what, const std::string& kind = {}) {
  return "<text x=\"" + pixels(x) + "\" y=\"" + pixels(y) + "\" text-anchor=\"" + anchor + "\"" +
         (kind.empty() ? "" : " class=\"" + kind + "\"") + ">" + escaped(what) + "</text>";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& kind) {
  return "<line class=\"" + kind + "\" x1=\"" + pixels(x1) + "\" y1=\"" + pixels(y1) + "\" x2=\"" + pixels(x2) +
         "\" y2=\"" + pixels(y2) + "\"/>";
}

std::string dots(const Eigen::VectorXd& x, const Series& series, const Axis& across, const Axis& up) {
  std::string result;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double y = series.values[i];
    if (!std::isfinite(y) || y < up.range.low || y > up.range.high) continue;
    result += "<circle class=\"" + series.style + "\" cx=\"" + pixels(across(x[i])) + "\" cy=\"" + pixels(up(y)) +
              "\" r=\"3\"/>";
  }
  return result;
}

// Of the points above one pixel the first, lowest, highest and last are enough.
std::string curve(const Eigen::VectorXd& x, const Series& series, const Axis& across, const Axis& up) {
  std::string path;
  bool drawing = false;
  for (Eigen::Index i = 0; i < x.size();) {
    if (!std::isfinite(series.values[i])) {
      drawing = false;
      ++i;
      continue;
    }
    const double column = std::floor(across(x[i]));
    Eigen::Index end = i, lowest = i, highest = i;
    for (; end < x.size() && std::isfinite(series.values[end]) && std::floor(across(x[end])) == column; ++end) {
      if (series.values[end] < series.values[lowest]) lowest = end;
      if (series.values[end] > series.values[highest]) highest = end;
    }
    std::array<Eigen::Index, 4> points{i, std::min(lowest, highest), std::max(lowest, highest), end - 1};
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (k > 0 && points[k] == points[k - 1]) continue;
      const double y = std::clamp(series.values[points[k]], up.range.low, up.range.high);
      path += std::string(drawing ? "L" : "M") + pixels(across(x[points[k]])) + " " + pixels(up(y));
      drawing = true;
    }
    i = end;
  }
  return path.empty() ? "" : "<path class=\"" + series.style + "\" d=\"" + path + "\"/>";
}

std::string draw_panel(const Chart& chart, const Panel& panel, const Axis& across, double top) {
  const double bottom = top + panel.height;
  const Axis up{y_range(panel), bottom, top};
  std::string result;
  for (const Stretch& stretch : chart.highlighted) {
    const double from = std::clamp(across(stretch.from), left, left + plot_width);
    const double to = std::clamp(across(stretch.to), left, left + plot_width);
    if (to <= from) continue;
    result += "<rect class=\"mark\" x=\"" + pixels(from) + "\" y=\"" + pixels(top) + "\" width=\"" +
              pixels(std::max(2.0, to - from)) + "\" height=\"" + pixels(panel.height) + "\"/>";
  }
  for (const double tick : ticks(up.range, panel.height > 100 ? 5 : 3)) {
    result += line(left, up(tick), left + plot_width, up(tick), "grid") +
              text(left - 6, up(tick) + 4.5, "end", rounded(tick));
  }
  for (const Series& series : panel.series) {
    constexpr Eigen::Index few = 60;  // measurements that are drawn one by one
    const bool points = isolated(series.values) || (series.style == "measured" && count_finite(series.values) <= few);
    result += points ? dots(chart.x, series, across, up) : curve(chart.x, series, across, up);
  }
  result += "<rect class=\"frame\" x=\"" + pixels(left) + "\" y=\"" + pixels(top) + "\" width=\"" + pixels(plot_width) +
            "\" height=\"" + pixels(panel.height) + "\"/>";
  return result;
}

std::string legend(const Chart& chart, double y) {
  std::string result;
  double x = left;
  for (const Series& series : chart.panels.front().series) {
    if (series.label.empty()) continue;
    result += "<path class=\"" + series.style + "\" d=\"M" + pixels(x) + " " + pixels(y - 4) + "h18\"/>" +
              text(x + 23, y, "start", series.label);
    x += 23 + 7.6 * static_cast<double>(series.label.size()) + 8;
  }
  return result;
}

}  // namespace

std::string chart_svg(const Chart& chart) {
  double height = legend_height + axis_height;
  for (const Panel& panel : chart.panels) height += title_height + panel.height + gap;
  const double first = chart.x.size() > 0 ? chart.x[0] : 0;
  const double last = chart.x.size() > 0 ? chart.x[chart.x.size() - 1] : 1;
  const Axis across{last > first ? Range{first, last} : Range{first, first + 1}, left, left + plot_width};

  std::string body = legend(chart, 15);
  double top = legend_height;
  for (const Panel& panel : chart.panels) {
    body += text(left, top + 15, "start", panel.title, "title");
    top += title_height;
    body += draw_panel(chart, panel, across, top);
    top += panel.height + gap;
  }
  const double base = top - gap;
  for (const double tick : ticks(across.range, 5)) {
    body += line(across(tick), base, across(tick), base + 5, "frame");
    const double half = 3.8 * static_cast<double>(rounded(tick).size());
    body += text(std::clamp(across(tick), left, left + plot_width - half), base + 19, "middle", rounded(tick));
  }
  body += text(left + plot_width, base + 36, "end", chart.x_title);
  const std::string size = pixels(width) + " " + pixels(height);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + "\" role=\"img\"><title>" +
         escaped(chart.title) + "</title><style>" + style + "</style><rect width=\"" + pixels(width) + "\" height=\"" +
         pixels(height) + "\" fill=\"#fff\"/>" + body + "</svg>\n";
}

}  // namespace diagnose_program

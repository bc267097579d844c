#include "learning_curve.hpp"

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "../../../apps/common/files.hpp"
#include "../../../apps/common/gnuplot.hpp"
#include "commands.hpp"
#include "published.hpp"

namespace sigmaban {
namespace {

using example::draw;
using example::read_text;

/// CPU seconds, cost of the current policy and of the best one so far, one line per measurement.
std::string curve(const std::filesystem::path& record) {
  std::ostringstream out;
  try {
    const auto json = nlohmann::json::parse(read_text(record));
    for (const auto& point : json.at("history")) {
      out << point.at("cpu_seconds").get<double>() << ' ' << point.at("cost").get<double>() << ' '
          << point.at("best_cost").get<double>() << '\n';
    }
  } catch (const nlohmann::json::exception&) {
    throw UsageError(record.string() + ": is not the record of a training, run `sigmaban_approach train` again");
  }
  return out.str() + "\n\n";
}

std::string panel(const std::string& problem, const std::string& title, int block, bool with_paper_settings) {
  const Published& known = published(problem);
  std::ostringstream out;
  out << "set title '" << title << "'\n"
      << "plot [:][7:150] " << known.rfpi << " title 'published RFPI, " << published_core_hours
      << " core-hours' lc rgb '#d55e00' dt 2 lw 1.5, " << known.near_optimal
      << " title 'near-optimal (grid)' lc rgb '#009e73' dt 4 lw 1.5, data index " << block
      << " using 1:2 with points pt 7 ps 0.4 lc rgb '#9ecae1' title 'RFPI, newest policy', '' index " << block
      << " using 1:3 with steps lc rgb '#0072b2' lw 2 title 'RFPI, best so far'";
  if (with_paper_settings) {
    out << ", '' index " << block + 1
        << " using 1:3 with steps lc rgb '#777777' lw 1.5 title 'RFPI, settings of the paper'";
  }
  out << '\n';
  return out.str();
}

}  // namespace

void draw_learning_curves(const Results& results) {
  std::string data;
  std::string commands =
      "set multiplot layout 1,2 title 'Learning the approach: mean cost of a run'\n"
      "set logscale xy\nset ytics (7, 8, 9, 10, 12, 15, 20, 30, 40, 50, 70, 100)\n"
      "set grid lc rgb '#e6e6e6' lt 1\nset key top right\n"
      "set xlabel 'CPU seconds'\nset ylabel 'cost'\n";
  int block = 0;
  for (const auto& [problem, title] : {std::pair{"ha", "HA"}, std::pair{"anha", "ANHA"}}) {
    const auto paper = record_of(results.paper(problem));
    data += curve(record_of(results.rfpi(problem)));
    if (exists(paper)) data += curve(paper);
    commands += panel(problem, title, block, exists(paper));
    block += exists(paper) ? 2 : 1;
  }
  draw(results.folder / "learning_curve", commands + "unset multiplot\n", data, 1100, 460);
}

}  // namespace sigmaban

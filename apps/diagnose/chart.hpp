// Curves over time as SVG, drawn by hand: one or more panels under each other with a common axis.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace diagnose_program {

struct Series {
  std::string label;       // in the legend; empty: not there
  std::string style;       // class of the style sheet in the picture: measured, nominal, before, after
  Eigen::VectorXd values;  // NaN: no point
};

struct Panel {
  std::string title;  // what is drawn, with its unit
  double height = 150;
  std::vector<Series> series;
};

struct Stretch {
  double from = 0, to = 0;
};

struct Chart {
  std::string title, x_title;
  Eigen::VectorXd x;
  std::vector<Panel> panels;
  std::vector<Stretch> highlighted;
};

/// Cost grows with the number of points, the size of the picture does not.
std::string chart_svg(const Chart& chart);

}  // namespace diagnose_program

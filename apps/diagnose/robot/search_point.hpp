// A point of the search: terms and their sizes, with the errors that a simulation leaves there.
#pragma once

#include "choose_terms.hpp"
#include "linearize.hpp"

namespace diagnose_robot {

struct Point {
  Eigen::VectorXd theta;
  TermSet set;
  std::vector<StartState> starts;  // of recordings
  Eigen::MatrixXd errors;
};

struct MoveCriteria {
  int most_halvings = 5;  // of a step that raises the errors
  double settled = 0.5;   // decrease of -2 log probability below which parameters no longer move: odds of 1.3
};

Eigen::MatrixXd errors_at(const Evidence& evidence, const Eigen::VectorXd& theta,
                          const std::vector<StartState>& starts);

/// What steps must lower: as the criterion of the linear model, without the cost of having terms.
double misfit(const Evidence& evidence, const LinearModel& model, const Point& point);

/// Cost of having the terms.
double cost_of(const LinearModel& model, const TermSet& set);

/// The two together: what a search lowers.
double misfit_and_cost(const Evidence& evidence, const LinearModel& model, const Point& point);

/// Along the linear model's change to this set, as far as errors fall. False if they do not.
bool move(const Evidence& evidence, const LinearModel& model, const TermSet& set, const MoveCriteria& criteria,
          Point& point);

/// Moves the point along its own terms until errors no longer fall. Cost: linearizations by these alone; derivatives by
/// others cost the most and are not needed.
/// Errors weigh as in `model`, that of all terms: with weights of its own the point would leave what others moved it to.
void settle(const Evidence& evidence, const LinearModel& model, int most_moves, Point& point);

}  // namespace diagnose_robot

// A diagnosis made linear at one point: how errors of each joint and block change with each term. Sums alone, so that
// sets of terms are compared without simulating. No MuJoCo here.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace diagnose_robot {

/// Of the errors r + X d of one joint in one block of rows.
struct Sums {
  Eigen::MatrixXd gram;   // X'X
  Eigen::VectorXd slope;  // X'r
  double square = 0;      // r'r
  double rows = 0;
};

using TermSet = std::vector<char>;  // by term: is it there

/// How the start of a recording, fitted again, follows the terms; joints that move each other.
struct StartFit {
  std::size_t recording = 0;
  std::vector<int> joints;
  std::vector<Eigen::Index> terms;
  Eigen::VectorXd change;   // with terms as they are: angles of the joints, then speeds
  Eigen::MatrixXd by_term;  // the same x place in `terms`
};

struct LinearModel {
  std::vector<std::vector<Sums>> sums;  // joint, block
  std::vector<Sums> whole;              // by joint, over all blocks; see add_up()
  Eigen::VectorXd independent;          // by joint: how many of its errors count as independent
  std::vector<int> pool;  // by joint: joints of one pool have errors of one size, since their motors are equal
  Eigen::VectorXd theta, low, high;       // by term
  Eigen::VectorXd prior;                  // scale of the term before anything is seen: Cauchy's density, large is rare
                                          // but possible
  Eigen::VectorXd smallest;               // size of the term below which nobody would correct a model
  Eigen::VectorXd cost;                   // of having the term, in -2 log of its odds
  std::vector<std::vector<int>> acts_on;  // by term: joints
  Eigen::VectorXd least_taken;  // by term: errors that it must take away, since simulations of one model differ by that
                                // much; empty: none
  std::vector<Eigen::MatrixXd> columns;            // by joint: row x place in `terms`; empty: rows are not known
  std::vector<Eigen::VectorXd> errors;             // by joint; NaN: unknown
  std::vector<std::vector<Eigen::Index>> terms;    // by joint: those that move it
  std::vector<StartFit> starts;                    // errors and columns are those with starts that follow
  TermSet of_groups;                               // by term: tied over a group
  std::vector<std::vector<Eigen::Index>> refines;  // by term: those of which one must be there too; empty: none
};

/// Fills `whole`.
void add_up(LinearModel& model);

struct LinearFit {
  Eigen::VectorXd change;  // of theta, by term
  Eigen::VectorXd square;  // predicted sum of squares by joint
  double criterion = 0;    // -2 log posterior, up to a constant
};

/// The minimum over the terms of `set`, within bounds; others go to 0. `without_block` is left out (-1: none).
LinearFit fit_linear(const LinearModel& model, const TermSet& set, int without_block = -1);

/// -2 log of the prior density of a term's size, up to a constant.
double prior_cost(const LinearModel& model, Eigen::Index term, double size);

/// Independent errors by joint, of those that the terms of `set` and all of groups leave, fitted together: what known
/// physics of whole groups takes away is no noise, however slowly it changes. Joints of a pool share the correlation.
Eigen::VectorXd independent_after(const LinearModel& model, const TermSet& set);

/// Mean squares of errors by joint, each that of its pool, from sums of squares over rows.
Eigen::VectorXd mean_squares(const LinearModel& model, const Eigen::VectorXd& square, const Eigen::VectorXd& rows);

/// The same of the rows of the model.
Eigen::VectorXd pooled_squares(const LinearModel& model, const Eigen::VectorXd& square);

/// Sum of squares of a joint in a block after a change.
double square_after(const Sums& sums, const Eigen::VectorXd& change);

/// Standard errors by term; 0 for those that are not there.
Eigen::VectorXd standard_errors(const LinearModel& model, const TermSet& set);

/// The minimum of x'Qx/2 + c'x for low <= x <= high.
Eigen::VectorXd bounded_minimum(const Eigen::MatrixXd& q, const Eigen::VectorXd& c, const Eigen::VectorXd& low,
                                const Eigen::VectorXd& high);

/// Autocorrelation time of some series with gaps (NaN), each of its own size [rows], at least 1: the larger of that of
/// slow errors (Geyer's initial positive sequence) and that of oscillating ones (Bartlett's sum of squares). Cost: rows
/// * lags.
double correlation_time(const std::vector<Eigen::VectorXd>& series);

/// Errors that count as independent in a series with gaps: rows over the autocorrelation time.
double independent_errors(const Eigen::Ref<const Eigen::VectorXd>& errors);

}  // namespace diagnose_robot

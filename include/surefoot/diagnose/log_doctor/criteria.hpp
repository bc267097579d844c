// Criteria of the log doctor: when a fault of a log is named.
#pragma once

#include <cstddef>

namespace surefoot::diagnosis {

struct LogDoctorCriteria {
  // Named is what chance and the scatter between recordings explain with less than this probability, shared out among
  // all tests of a log; and what halves the error, for missing physics makes small but significant differences too.
  double significance = 1e-3;
  double fault_odds = 100;      // that a column is at fault, times all columns asked for: one log in ten has such a
                                // fault, and named is what is ten times as probable as none
  double decisive = 4;          // least mean square error as logged over that after the repair
  double in_doubt = 0.1;  // of an output's variance unexplained in the median recording: columns of all recordings
                          // are tried, of which a decisive gain is asked
  double poor_fit = 0.25;  // of it unexplained: other parameters are searched for, and a recording may be unrelated
  double most_of = 0.8;         // share of the recordings that a fault of the whole log must be seen in
  double deviations = 3;         // standard deviations beyond half of them, where recordings are many and short
  std::size_t search_points = 8;  // of the search for parameters where the fit is poor
  std::size_t fewest_rows = 40;  // of a recording, for what concerns its clock or its sensors
  std::size_t fit_rows = 10000;  // of the light calibration, over as many recordings as that gives
  std::size_t few_fitted = 6;    // recordings at least
  int fit_iterations = 6;        // of each of its rounds
  int fit_rounds = 3;            // with each recording weighted by what is left of it

  std::size_t blocks = 8;           // of a recording, left out in turn for the standard error of its clock
  double most_shift = 40;           // rows that outputs may be early or late by
  double most_skew = 0.05;          // of the time: clocks are worse only if they are broken
  double read_skews = 201;          // rates of the outputs' clock that are tried
  double simulated_skews = 11;      // rates of a recording's clock, each simulated
  double skew_gain = 1.5;           // least ratio of mean square errors for a rate: motions hide most of it, and the
                                    // scatter of all clocks decides already

  double suspect_gain = 2;  // least ratio for offsets that are tried beside physics that is missing, and for columns
                            // that take parameters off their bounds

  double gap = 10;                 // times the median interval: rows are missing
  double gap_against_others = 3;   // times what one in twenty intervals exceed
  std::size_t fewest_equal = 3;    // equal readings in a row that may be a stretch, if chance hardly makes as many
  std::size_t constant_rows = 5;   // that are one in any case, and do not tell what chance makes
  double repeats = 0.05;           // share of rows that repeat the one before while the model moves on
  double odd = 0.5;                // least share of its variance unexplained: physics that is missing leaves less
  double far_off = 5;              // times as far off as any other, where parameters of its own explain it
  double runs_away = 100;          // times what outputs move: that far off, the steps of a simulation are to blame
};

}  // namespace surefoot::diagnosis

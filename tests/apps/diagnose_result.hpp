// A made-up diagnosis with something in every field, for tests of what is written.
#pragma once

#include <cmath>
#include <string>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace diagnose_test {

inline surefoot::SimulatorInfo some_simulator() {
  surefoot::SimulatorInfo info;
  info.name = "servo <pendulum>";
  info.outputs = {{"theta_rad", "rad"}};
  return info;
}

inline surefoot::Curve some_curve(const std::string& recording) {
  constexpr Eigen::Index rows = 400;
  surefoot::Curve curve;
  curve.recording = recording;
  curve.time = Eigen::VectorXd::LinSpaced(rows, 0, 2);
  curve.measured = curve.time.array().sin().matrix().transpose();
  curve.nominal = 1.3 * curve.measured;
  curve.before = 1.1 * curve.measured;
  curve.after = 1.01 * curve.measured;
  for (Eigen::Index row = 100; row < 120; ++row) curve.measured(0, row) = std::nan("");
  return curve;
}

inline surefoot::Diagnosis some_diagnosis() {
  surefoot::Diagnosis d;
  d.model = "servo <pendulum>";
  d.verdict = surefoot::Verdict::missing_physics;
  d.sentence = "The model leaves out dry friction of 0.121 N m at omega; with it the error falls to a tenth.";
  d.fit = {"rec_3.csv", "rec_4.csv"};
  d.select = {"rec_5_with_a_name_that_is_much_longer_than_one_would_wish_for_in_a_narrow_window.csv"};
  d.held_out = {"rec_1.csv", "rec_2.csv"};
  d.log_faults = {{.kind = "sign_flipped",
                   .recording = "rec_4.csv",
                   .channel = "theta_rad",
                   .size = -1,
                   .sentence = "rec_4.csv: theta_rad has the opposite sign",
                   .cure = "flip its sign"}};
  d.remarks = {{"rec_3.csv", "row 12: a single outlier of theta_rad, left out"}};
  d.parameters = {{{"kt", "N m/A", 1.48, 1.45, 1.51}, 1.6}, {{"R", "ohm", 15, 14.8, 15}, 3.6, true}};
  d.augmented_parameters = d.parameters;
  d.correlated = {"kt and R (0.98)"};
  d.noise_sentence = "The noise is measurement noise.";
  d.noise_findings = {{"theta_rad",
                       "correlated_noise",
                       {{"time", "s", 0.03, 0.025, 0.036}},
                       0.12,
                       1e-6,
                       "noise of theta_rad is correlated over 0.03 s"}};
  d.forest_residual = {true, true, 0.4, 0.05, 0.0041, 0.0021, {}};
  d.channels = {{"theta_rad", "rad", 0.09, 0.05, 0.004, 0.001, 1e-9}};
  d.regions = {{"abs(omega) < 0.12 and since_reversal < 0.06", 0.71, 0.09, 0.002}};
  d.intervals = {{"rec_1.csv", 0.5, 0.9, 0.05}, {"rec_2.csv", 1.0, 1.2, 0.03}};
  d.effects = {{"coulomb_friction",
                "omega",
                "dry friction of 0.121 N m at omega",
                {{"level", "N m", 0.121, 0.115, 0.127}},
                {0.63, 0.04, 0.001, 0.97},
                "",
                ""}};
  d.alternatives = {{{{"stribeck_friction", "omega"}}, 0.0041, 0.2, true},
                    {{{"viscous_friction", "omega"}, {"first_order_lag", "goal"}}, 0.02, 0.01, false}};
  d.probability = 0.77;
  d.limits = {{"backlash", "theta", {"half_width", "rad", 0.002, 0.001, 0.003}}};
  d.next_experiment = "a slow ramp";
  d.training_before = 0.050;
  d.training_after = 0.0040;
  d.held_out_before = 0.052;
  d.held_out_after = 0.0041;
  d.held_out_forest = 0.011;
  d.noise_floor = 0.0012;
  d.gain_low = 0.06;
  d.gain_high = 0.1;
  d.per_recording = {{"rec_1.csv", 0.05, 0.004}, {"rec_2.csv", 0.06, 0.005, 0.005, 40, true}};
  d.curves = {some_curve("rec_1.csv"), some_curve("rec_2.csv")};
  d.seconds = 12.3;
  d.seed = 7;
  return d;
}

}  // namespace diagnose_test

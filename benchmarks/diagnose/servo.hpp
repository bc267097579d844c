// Common parts of the benchmarks of this folder: the servo pendulum in C++, as recordings, and as the text of a model
// file.
#pragma once

#include <cmath>
#include <cstddef>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#include "tests/support/servo_pendulum.hpp"

namespace diagnose_benchmarks {

inline constexpr int recording_count = 8, rows_per_recording = 1200;  // 6 s at 200 Hz

/// The equations of toys::ServoPendulum, signal for signal.
inline constexpr const char* servo_model_text = R"toml(
schema = "surefoot.model/1"
name   = "servo pendulum"
kind   = "ode"
time   = "t_s"

[inputs]
goal = "goal_rad"

[let]
duty = "min(max(10*(goal - theta), -1), 1)"
tau  = "kt/R*(12*duty - kt*omega)"

[states.theta]
rate = "omega"
initial = "0"
unit = "rad"
[states.omega]
rate = "(tau - 0.5*9.81*0.15*sin(theta))/(armature + 0.01125)"
initial = "0"
unit = "rad/s"
effort = "armature + 0.01125"
effort_unit = "N m"

[outputs]
theta_rad = { value = "theta", unit = "rad" }

[parameters]
kt = { value = 1.6, min = 0.3, max = 5, unit = "N m/A" }
R = { value = 3.6, min = 0.5, max = 15, unit = "ohm" }
armature = { value = 0.012, min = 0.0005, max = 0.1, unit = "kg m^2" }
)toml";

/// An effect of the machine that the model leaves out; none without a name.
inline std::vector<surefoot::NamedEffect> left_out(const std::string& effect) {
  if (effect == "coulomb_friction") return {{.name = effect, .attached_to = "omega", .values = {0.12}}};  // [N m]
  if (effect == "input_delay") return {{.name = effect, .attached_to = "goal", .values = {0.012}}};       // [s]
  return {};
}

/// Recordings of a machine with that effect and parameters a little off, `times` as many rows as usual; noise of
/// 1 mrad, correlated from row to row.
inline std::vector<surefoot::Recording> servo_recordings(const std::string& effect, int times) {
  const surefoot::Augmented machine{
      .parameters = {1.5, 3.8, 0.0125}, .effects = left_out(effect), .integration = {.step = 0.001}};
  std::vector<surefoot::Recording> recordings;
  for (int r = 0; r < recording_count; ++r) {
    const Eigen::Index rows = Eigen::Index{rows_per_recording} * times;
    surefoot::Recording recording;
    recording.name = "recording " + std::to_string(r);
    recording.time.setLinSpaced(rows, 0, 0.005 * static_cast<double>(rows - 1));
    recording.inputs.resize(1, rows);
    recording.outputs.setZero(1, rows);
    recording.initial = recording.initial_scale = Eigen::Vector2d::Zero();
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double t = recording.time[i];
      recording.inputs(0, i) =
          r % 2 == 1 ? std::sin(t * (1 + 0.7 * r)) : (std::fmod(t, 1.4) < 0.7 ? 0.6 : -0.4) * (1 + 0.1 * r);
    }
    recording.outputs = simulate_augmented(toys::ServoPendulum{}, machine, recording).outputs;
    surefoot::Rng rng(1, static_cast<std::uint64_t>(r));
    double noise = 0;
    for (double& value : recording.outputs.reshaped()) {
      noise = 0.4 * noise + 0.001 * rng.normal();
      value += noise;
    }
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

/// CPU time that a job takes in all threads [s].
template <class Job>
double cpu_time(Job&& job) {
  const std::clock_t begin = std::clock();
  job();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

inline double row_count(const std::vector<surefoot::Recording>& recordings) {
  double rows = 0;
  for (const surefoot::Recording& recording : recordings) rows += static_cast<double>(recording.rows());
  return rows;
}

}  // namespace diagnose_benchmarks

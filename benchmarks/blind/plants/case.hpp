// A case of the blind benchmark: a system, its faults, its readings, and how much the faults matter.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plant.hpp"
#include "readings.hpp"

namespace plants {

enum class Kind { nothing, one, two, outside };

/// Errors of one recording over its full length, in standard deviations of the noise.
struct RecordingError {
  std::string name;
  bool held_out = false;  // not used to calibrate the nominal model
  double actual = 0, calibrated = 0;
  double actual_with_outliers = 0;  // 0: not computed
};

struct Case {
  std::string name;
  Kind kind = Kind::nothing;
  System system;
  Sensing sensing;
  bool noise_shown = false;  // the model file states the noise
  std::vector<Fault> faults;
  Values calibrated;  // nominal parameters fitted without faults
  std::vector<RecordingError> errors;
  double actual_rmse = 0, calibrated_rmse = 0;            // held-out, full length
  double actual_step_rmse = 0, calibrated_step_rmse = 0;  // walks: held-out, step by step
  std::vector<double> strength_each;                      // of each fault while the others are known
  double strength() const { return calibrated_rmse / actual_rmse; }
};

std::string name_of(Kind kind);

/// Draws until the faults matter: the calibrated nominal model's held-out error is at least 1.2 times the true model's.
Case draw_case(Random& random, const std::string& family, Kind kind);

/// Writes DIR/<name>/ with the model file and the recordings.
void write_case(const Case& one, const std::filesystem::path& folder);

/// Writes the hidden ground truth.
void write_truth(const Case& one, const std::filesystem::path& file);

}  // namespace plants

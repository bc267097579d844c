// The context of a diagnosis: options, threads, seed and time, which every stage of it may ask for.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "surefoot/diagnose/estimation/hypothesis.hpp"
#include "surefoot/diagnose/options.hpp"

namespace surefoot::diagnosis {

/// Binds the user's simulator to recordings.
using BindSimulator = std::function<BoundSimulator(std::vector<Recording>)>;

/// Of the time that is given: what calibration and search may take.
inline constexpr double search_share = 0.85;

/// Shares of the work done at the begin of a stage, as far as it is known beforehand.
inline constexpr double progress_calibration = 0.05, progress_search = 0.15, progress_evaluation = 0.85;

/// How a diagnosis is run: what every stage may ask for.
struct RunContext {
  const DiagnoseOptions& options;
  const Parallel& parallel;
  std::uint64_t seed = 1;
  std::stop_token stop = {};
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();

  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); }
  bool has_ended() const { return stop.stop_requested() || seconds() > options.max_seconds; }
  /// The rest of the time is for fits without each held-out recording: unless these are made, errors are of recordings
  /// that were fitted.
  bool search_has_ended() const { return has_ended() || seconds() > search_share * options.max_seconds; }
  /// Whether what has taken since `started` [s], as seconds() gave it, could be done once more.
  bool has_time_for_as_much_again(double started) const { return 2 * seconds() - started <= options.max_seconds; }
  void progress(std::string_view stage, double share, std::string_view best = "") const {
    if (options.on_progress) options.on_progress(stage, share, best);
  }
};

}  // namespace surefoot::diagnosis

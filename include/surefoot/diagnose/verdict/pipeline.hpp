// The stages of a diagnosis, one after the other.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/data_split.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"
#include "surefoot/diagnose/screening.hpp"
#include "surefoot/diagnose/selection/search.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

/// Cuts few recordings into parts, so that some can be held out. States at the cuts are those of the calibrated
/// simulation, to be estimated from there on; where an output reads a state it starts from the measurement.
std::vector<Recording> cut_recordings(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                      const std::vector<SimulatedRun>& trajectories, std::size_t parts);

/// An initial state that was read off a sensor is known as well as that sensor reads: it is estimated, within its
/// noise.
void free_measured_starts(BoundSimulator& bound, const std::vector<std::size_t>& training);

/// At most `count` recordings, evenly chosen.
std::vector<std::size_t> some_of(const std::vector<std::size_t>& recordings, std::size_t count);

/// Runs all stages. `make` binds the simulator to recordings.
Investigation run_pipeline(const std::function<BoundSimulator(std::vector<Recording>)>& make, const SimulatorInfo& info,
                           std::vector<Recording> recordings, const DiagnoseOptions& options, const Parallel& parallel,
                           std::uint64_t seed, std::stop_token stop);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/pipeline.ipp"
#endif

// The command line of surefoot-diagnose for a simulator of your own in C++:
//
//   int main(int argc, char** argv) { return surefoot_diagnose_main(argc, argv, MySimulator{}); }
//
// Columns of the recordings are called after the names and units of inputs and outputs ("goal_rad"), the time t_s.
// Link surefoot::apps.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <string>

#include "surefoot/core/executor.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/recording.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace surefoot {

/// A constant from the first lines of a recording. Throws DiagnoseError if it is not there.
double constant_of(const Recording& recording, const std::string& key);

}  // namespace surefoot

namespace surefoot_apps {

/// surefoot::diagnose() of some simulator.
using DiagnoseFunction =
    std::function<surefoot::Diagnosis(std::span<const surefoot::Recording>, const surefoot::DiagnoseOptions&,
                                      const surefoot::Threads&, std::uint64_t seed, std::stop_token)>;

/// The simulator must outlive the function.
template <surefoot::Simulator S>
DiagnoseFunction diagnose_function(const S& simulator) {
  return [&simulator](std::span<const surefoot::Recording> recordings, const surefoot::DiagnoseOptions& options,
                      const surefoot::Threads& threads, std::uint64_t seed, std::stop_token stop) {
    return surefoot::diagnose(simulator, recordings, options, threads, seed, stop);
  };
}

/// Reads the options, diagnoses, writes the files and prints a summary. Returns the exit code.
int diagnose_main(int argc, char** argv, const surefoot::SimulatorInfo& info, const DiagnoseFunction& diagnose);

}  // namespace surefoot_apps

template <surefoot::Simulator S>
int surefoot_diagnose_main(int argc, char** argv, const S& simulator) {
  return surefoot_apps::diagnose_main(argc, argv, simulator.info(), surefoot_apps::diagnose_function(simulator));
}

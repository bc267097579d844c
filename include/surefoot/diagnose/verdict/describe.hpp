// Description of a diagnosis in values with intervals and in sentences.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/estimation/standard_errors.hpp"

namespace surefoot::diagnosis {

struct DescriptionCriteria {
  double bound_share = 1e-3;  // of a parameter's range: nearer to a bound it is said to be at the bound
  double correlation = 0.95;  // of two parameters, from which on they are named: errors are three times as large
};

std::vector<CalibratedParameter> calibrated_parameters(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                       const StandardErrors& errors,
                                                       const DescriptionCriteria& criteria = {});

/// Pairs of parameters that the recordings hardly separate.
std::vector<std::string> correlated_pairs(const BoundSimulator& bound, const StandardErrors& errors,
                                          const DescriptionCriteria& criteria = {});

/// One effect of a hypothesis; without `errors` its intervals are its values.
FoundEffect describe(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t effect,
                     const StandardErrors* errors);

std::string noise_sentence(NoiseKind noise);

/// For effects that held-out recordings rejected.
std::string rejection_sentence();

/// For outputs whose stated noise is more than twice what is left of them, each by its name; empty where there are none.
std::string overstated_noise_sentence(const std::vector<ChannelMismatch>& outputs);

/// For held-out recordings that nothing was fitted without.
std::string not_held_out_sentence();

/// For a state that recordings do not begin with as the model says: between which values that is off.
std::string freed_state_sentence(const StateInfo& state, double least_off, double most_off);

/// For an input of which the recordings say that it goes another way between rows than is said, or held if nothing is.
std::string hold_sentence(const std::string& input, InputHold hold, InputHold said);

/// That friction at one of these velocities may have to move the others too.
std::string moved_together_sentence(const SimulatorInfo& info, const std::vector<int>& velocities);

/// That forces were not tried, for no state is known to be a speed.
std::string no_speed_sentence();

/// That whole recordings cannot be simulated, and predictions over so many rows are compared instead; for a chaotic
/// motion or, if not, a machine that is unstable by itself.
std::string following_sentence(double rows, bool chaotic);

/// That a recording was cut, the first time after so many seconds, where its start no longer tells what it does.
std::string sensitive_recording_sentence(double seconds, std::size_t parts);

/// That no more effects were combined than may be, while something is left.
std::string most_effects_sentence(int most);

/// How to tell the last of the chosen effects from the last of another choice.
std::string next_experiment(const Hypothesis& chosen, const Hypothesis& other);

/// The diagnosis in one sentence, or two; `ties`: names of choices that cannot be told from the one made.
std::string verdict_sentence(const Diagnosis& diagnosis, const std::vector<std::string>& ties);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/describe.ipp"
#endif

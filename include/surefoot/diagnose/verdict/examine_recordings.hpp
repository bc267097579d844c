// The log doctor in the course of a diagnosis: by the model as it is, and again with the effects that were found.
#pragma once

#include <vector>

#include "surefoot/diagnose/log_doctor/examine_log.hpp"
#include "surefoot/diagnose/verdict/run_context.hpp"

namespace surefoot::diagnosis {

/// All effects that may be named: those of the library and the user's own.
std::vector<Effect> nameable_effects(const DiagnoseOptions& options);

/// The simulator as it is, with the effects that are part of the model already.
Hypothesis nominal_with_known(const BoundSimulator& bound, const DiagnoseOptions& options);

/// Looks for faults of the log; they are marked as repaired only if that is asked for.
LogExamination examine_recordings(const BindSimulator& bind, const std::vector<Recording>& recordings,
                                  const RunContext& run);

/// The model with the effects that were found.
struct FoundModel {
  Hypothesis hypothesis;
  Sizes sizes;                   // typical ones, of which the bounds of effects are multiples
  std::vector<InputHold> holds;  // of inputs, as in Integration
  std::vector<bool> freed;       // states that begin otherwise than the model says
  bool named = true;             // otherwise the effects only come nearest: too few recordings show them
  double follow = 0;             // Integration::follow that the machine needs with them
};

/// The effects that were found, with their parameters, beside initial states as recordings have them.
Hypothesis with_found(const BoundSimulator& bound, const FoundModel& found);

/// The same by a model with the effects that were found: physics that was missing hides a clock that is some percent
/// off, or one recording's sensor that sticks. It goes on when the time of the search has ended. Faults named before
/// are asked for again, since these effects may bend to what they repair.
LogExamination examine_with_effects(const BindSimulator& bind, const std::vector<Recording>& recordings,
                                    const FoundModel& found, const RunContext& run,
                                    const std::vector<LogFault>& named = {});

/// Whether a fault is named once more in recordings that were repaired: the model without the effects was wrong about
/// it.
bool is_named_again(const std::vector<LogFault>& repaired, const std::vector<LogFault>& named);

/// Withdraws that a recording is unlike the others, where there was no time to ask whether it is with what was found;
/// unless it was left out.
void withdraw_odd_recording(LogExamination& log);

/// Withdraws faults that the model with what was found does not name again: some physics, or an initial state, passed
/// for them. Those that were repaired only if all can begin anew; true if it must.
bool withdraw_faults(LogExamination& log, const LogExamination& again, bool can_begin_anew);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/examine_recordings.ipp"
#endif

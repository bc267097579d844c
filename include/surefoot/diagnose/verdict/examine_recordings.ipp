// Definitions of surefoot/diagnose/verdict/examine_recordings.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/log_doctor/log_repair.hpp"
#include "surefoot/diagnose/selection/choose_initial_states.hpp"
#include "surefoot/diagnose/verdict/examine_recordings.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::vector<Effect> nameable_effects(const DiagnoseOptions& options) {
  std::vector<Effect> effects = all_effects();
  append_items(effects, options.more_effects);
  return effects;
}

SUREFOOT_ONCE Hypothesis nominal_with_known(const BoundSimulator& bound, const DiagnoseOptions& options) {
  const std::vector<Effect> effects = nameable_effects(options);
  Hypothesis hypothesis = nominal_hypothesis(bound);
  for (const NamedEffect& named : options.known) {
    hypothesis.effects.push_back(attach(bound.info, named, effects));
    const Eigen::Map<const Eigen::VectorXd> values(named.values.data(), static_cast<Eigen::Index>(named.values.size()));
    hypothesis.values.push_back(
        values_before_starts(*hypothesis.effects.back().effect, values, bound.recordings.size()));
  }
  return hypothesis;
}

/// The examination by a model that is calibrated from these parameters on, until it is stopped.
SUREFOOT_ONCE LogExamination examine(const BindSimulator& bind, const std::vector<Recording>& recordings,
                                     const std::function<Hypothesis(const BoundSimulator&)>& model,
                                     const RunContext& run, std::function<bool()> stopped,
                                     const std::vector<LogFault>& named = {}) {
  const bool may_leave_out = run.options.held_out.empty();  // which names recordings
  LogExamination examined =
      examine_log({bind, model, run.parallel, {}, std::move(stopped), named, may_leave_out}, recordings);
  if (run.options.repair) return examined;
  for (LogFault& fault : examined.faults) fault.repaired = false;
  return examined;
}

SUREFOOT_ONCE LogExamination examine_recordings(const BindSimulator& bind, const std::vector<Recording>& recordings,
                                                const RunContext& run) {
  return examine(
      bind, recordings, [&](const BoundSimulator& bound) { return nominal_with_known(bound, run.options); }, run,
      [run] { return run.search_has_ended(); });
}

SUREFOOT_ONCE Hypothesis with_found(const BoundSimulator& bound, const FoundModel& found) {
  Hypothesis hypothesis = nominal_hypothesis(bound);
  hypothesis.parameters = found.hypothesis.parameters;
  hypothesis.effects = found.hypothesis.effects;
  for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
    hypothesis.values.push_back(
        values_before_starts(*hypothesis.effects[e].effect, found.hypothesis.values[e], bound.recordings.size()));
  }
  return hypothesis;
}

SUREFOOT_ONCE LogExamination examine_with_effects(const BindSimulator& bind, const std::vector<Recording>& recordings,
                                                  const FoundModel& found, const RunContext& run,
                                                  const std::vector<LogFault>& named) {
  const auto bind_as_found = [&](std::vector<Recording> logged) {
    BoundSimulator bound = bind(std::move(logged));
    bound.sizes = found.sizes;
    bound.integration.inputs = found.holds;
    bound.integration.follow = std::max(bound.integration.follow, found.follow);
    for (std::size_t i = 0; i < found.freed.size(); ++i) {
      if (found.freed[i]) set_initial_scale(bound, i, found.sizes.state[i]);
    }
    return bound;
  };
  return examine(
      bind_as_found, recordings, [&](const BoundSimulator& bound) { return with_found(bound, found); }, run,
      [run] { return run.has_ended(); }, named);
}

SUREFOOT_ONCE bool is_named_again(const std::vector<LogFault>& repaired, const std::vector<LogFault>& named) {
  for (const LogFault& one : repaired) {
    for (const LogFault& other : named) {
      if (one.kind == other.kind && one.recording == other.recording && one.channel == other.channel) return true;
    }
  }
  return false;
}

SUREFOOT_ONCE void withdraw_odd_recording(LogExamination& log) {
  drop_items(log.faults,
             [](const LogFault& fault) { return fault.kind == name_of(LogFaultKind::odd) && !fault.repaired; });
}

SUREFOOT_ONCE bool withdraw_faults(LogExamination& log, const LogExamination& again, bool can_begin_anew) {
  bool repaired = false;
  drop_items(log.faults, [&](const LogFault& fault) {
    const bool withdrawn = !is_named_again({fault}, again.faults) && (can_begin_anew || !fault.repaired);
    repaired = repaired || (withdrawn && fault.repaired);
    return withdrawn;
  });
  if (repaired) log.repaired = again.repaired;
  return repaired;
}

}  // namespace surefoot::diagnosis

#include "write_json.hpp"

#include <nlohmann/json.hpp>

#include "json_number.hpp"

namespace diagnose_program {
namespace {

using Json = nlohmann::ordered_json;
using surefoot::Diagnosis;

Json interval(const surefoot::FittedValue& fit) {
  return Json::array({finite_or_null(fit.low), finite_or_null(fit.high)});
}

Json parameters_json(const std::vector<surefoot::CalibratedParameter>& parameters) {
  Json list = Json::array();
  for (const auto& parameter : parameters) {
    list.push_back({{"name", parameter.fit.name},
                    {"nominal", finite_or_null(parameter.nominal)},
                    {"calibrated", finite_or_null(parameter.fit.value)},
                    {"ci95", interval(parameter.fit)},
                    {"unit", parameter.fit.unit},
                    {"at_bound", parameter.at_bound},
                    {"fixed", parameter.fixed}});
  }
  return list;
}

Json mismatch_json(const Diagnosis& diagnosis) {
  Json channels = Json::array(), regions = Json::array(), intervals = Json::array();
  for (const auto& channel : diagnosis.channels) {
    channels.push_back({{"output", channel.output},
                        {"unit", channel.unit},
                        {"rmse_nominal", finite_or_null(channel.rmse_nominal)},
                        {"rmse_calibrated", finite_or_null(channel.rmse_calibrated)},
                        {"rmse_after", finite_or_null(channel.rmse_after)},
                        {"noise", finite_or_null(channel.noise)},
                        {"noise_stated", channel.noise_stated},
                        {"p_value", finite_or_null(channel.p_value)}});
    if (channel.noise_amplification > 1) channels.back()["noise_amplification"] = channel.noise_amplification;
  }
  for (const auto& region : diagnosis.regions) {
    regions.push_back({{"rule", region.rule},
                       {"share_of_excess", finite_or_null(region.share_of_excess)},
                       {"share_of_samples", finite_or_null(region.share_of_samples)},
                       {"p_value", finite_or_null(region.p_value)}});
  }
  for (const auto& one : diagnosis.intervals) {
    intervals.push_back({{"recording", one.recording},
                         {"from", finite_or_null(one.from)},
                         {"to", finite_or_null(one.to)},
                         {"share_of_excess", finite_or_null(one.share_of_excess)}});
  }
  return {{"channels", channels}, {"regions", regions}, {"intervals", intervals}};
}

Json fitted_json(const std::vector<surefoot::FittedValue>& values) {
  Json list = Json::array();
  for (const auto& fit : values) {
    list.push_back({{"name", fit.name},
                    {"value", finite_or_null(fit.value)},
                    {"ci95", interval(fit)},
                    {"unit", fit.unit},
                    {"at_bound", fit.at_bound}});
  }
  return list;
}

Json effects_json(const std::vector<surefoot::FoundEffect>& effects) {
  Json list = Json::array();
  for (const auto& effect : effects) {
    Json one = {{"name", effect.name}, {"attached_to", effect.attached_to}, {"sentence", effect.sentence}};
    if (!effect.form.empty()) one["form"] = effect.form;
    if (!effect.other.empty()) one["with"] = effect.other;
    one["parameters"] = fitted_json(effect.parameters);
    one["evidence"] = {{"heldout_gain", finite_or_null(effect.evidence.gain)},
                       {"gain_stderr", finite_or_null(effect.evidence.gain_stderr)},
                       {"p_value", finite_or_null(effect.evidence.p_value)},
                       {"confidence", finite_or_null(effect.evidence.confidence)}};
    list.push_back(one);
  }
  return list;
}

Json alternatives_json(const Diagnosis& diagnosis) {
  Json list = Json::array();
  for (const auto& alternative : diagnosis.alternatives) {
    Json effects = Json::array();
    for (const auto& [name, attached_to] : alternative.effects) {
      effects.push_back({{"name", name}, {"attached_to", attached_to}});
    }
    list.push_back({{"effects", effects},
                    {"fitted_rmse", finite_or_null(alternative.fitted_rmse)},
                    {"heldout_rmse", finite_or_null(alternative.held_out_rmse)},
                    {"probability", finite_or_null(alternative.probability)},
                    {"indistinguishable", alternative.indistinguishable}});
  }
  return list;
}

// The chosen structure and all others, with their probabilities.
Json structures_json(const Diagnosis& diagnosis) {
  Json chosen = Json::array(), list = Json::array();
  for (const auto& effect : diagnosis.effects) {
    chosen.push_back({{"name", effect.name}, {"attached_to", effect.attached_to}});
  }
  list.push_back({{"effects", chosen},
                  {"probability", finite_or_null(diagnosis.probability)},
                  {"heldout_rmse", finite_or_null(diagnosis.held_out_after)}});
  for (const Json& other : alternatives_json(diagnosis)) {
    list.push_back({{"effects", other["effects"]},
                    {"probability", other["probability"]},
                    {"heldout_rmse", other["heldout_rmse"]}});
  }
  return list;
}

Json fit_json(const Diagnosis& diagnosis) {
  Json recordings = Json::array();
  for (const auto& one : diagnosis.per_recording) {
    recordings.push_back({{"recording", one.recording},
                          {"before", finite_or_null(one.before)},
                          {"after", finite_or_null(one.after)},
                          {"beyond_noise", one.beyond_noise}});
  }
  return {{"train",
           {{"rmse_before", finite_or_null(diagnosis.training_before)},
            {"rmse_after", finite_or_null(diagnosis.training_after)}}},
          {"heldout",
           {{"rmse_before", finite_or_null(diagnosis.held_out_before)},
            {"rmse_after", finite_or_null(diagnosis.held_out_after)},
            {"rmse_forest", finite_or_null(diagnosis.held_out_forest)},
            {"noise_floor", finite_or_null(diagnosis.noise_floor)},
            {"ratio_ci95", Json::array({finite_or_null(diagnosis.gain_low), finite_or_null(diagnosis.gain_high)})},
            {"per_recording", recordings}}}};
}

Json limits_json(const Diagnosis& diagnosis) {
  Json list = Json::array();
  for (const auto& limit : diagnosis.limits) {
    list.push_back({{"name", limit.name},
                    {"attached_to", limit.attached_to},
                    {"parameter", limit.smallest.name},
                    {"smallest", finite_or_null(limit.smallest.value)},
                    {"unit", limit.smallest.unit}});
  }
  return list;
}

Json noise_json(const Diagnosis& diagnosis) {
  Json list = Json::array();
  for (const auto& noise : diagnosis.noise_findings) {
    list.push_back(
        {{"name", noise.name},
         {"output", noise.output},
         {"parameters", fitted_json(noise.parameters)},
         {"evidence", {{"likelihood_gain", finite_or_null(noise.gain)}, {"p_value", finite_or_null(noise.p_value)}}},
         {"sentence", noise.sentence}});
  }
  return list;
}

Json forest_json(const surefoot::ForestResidual& forest) {
  Json json = {{"kept", forest.kept},
               {"heldout_rmse", finite_or_null(forest.held_out_after)},
               {"heldout_rmse_without", finite_or_null(forest.held_out_before)}};
  if (forest.tried) json["gain"] = finite_or_null(forest.gain);
  if (forest.tried) json["gain_stderr"] = finite_or_null(forest.gain_stderr);
  if (forest.kept) json["file"] = residual_file;
  return json;
}

Json remarks_json(const Diagnosis& diagnosis) {
  Json list = Json::array();
  for (const auto& remark : diagnosis.remarks) list.push_back({{"recording", remark.recording}, {"text", remark.text}});
  return list;
}

Json log_faults_json(const Diagnosis& diagnosis) {
  Json list = Json::array();
  for (const auto& fault : diagnosis.log_faults) {
    list.push_back({{"kind", fault.kind},
                    {"recording", fault.recording},
                    {"channel", fault.channel},
                    {"size", finite_or_null(fault.size)},
                    {"unit", fault.unit},
                    {"sentence", fault.sentence},
                    {"cure", fault.cure},
                    {"repaired", fault.repaired}});
  }
  return list;
}

}  // namespace

std::string verdict_text(surefoot::Verdict verdict) {
  switch (verdict) {
    case surefoot::Verdict::adequate:
      return "adequate";
    case surefoot::Verdict::parameters_only:
      return "parameters-only";
    case surefoot::Verdict::missing_physics:
      return "missing-physics";
    case surefoot::Verdict::unfinished:
      return "search-not-finished";
    case surefoot::Verdict::unexplained:
      break;
  }
  return "unexplained";
}

std::string diagnosis_json(const Diagnosis& diagnosis) {
  const Json json = {
      {"schema", "surefoot.diagnosis/1"},
      {"model", diagnosis.model},
      {"complete", diagnosis.complete},
      {"verdict", verdict_text(diagnosis.verdict)},
      {"sentence", diagnosis.sentence},
      {"probability", finite_or_null(diagnosis.probability)},
      {"none_of_these", finite_or_null(diagnosis.probability_of_none)},
      {"noise_ratio", finite_or_null(diagnosis.noise_ratio)},
      {"structures", structures_json(diagnosis)},
      {"recordings", {{"fit", diagnosis.fit}, {"select", diagnosis.select}, {"test", diagnosis.held_out}}},
      {"parameters", parameters_json(diagnosis.parameters)},
      {"augmented_parameters", parameters_json(diagnosis.augmented_parameters)},
      {"correlated", diagnosis.correlated},
      {"noise", noise_json(diagnosis)},
      {"noise_sentence", diagnosis.noise_sentence},
      {"mismatch", mismatch_json(diagnosis)},
      {"effects", effects_json(diagnosis.effects)},
      {"known_effects", effects_json(diagnosis.known_effects)},
      {"alternatives", alternatives_json(diagnosis)},
      {"limits", limits_json(diagnosis)},
      {"next_experiment", diagnosis.next_experiment},
      {"fit", fit_json(diagnosis)},
      {"forest_residual", forest_json(diagnosis.forest_residual)},
      {"remarks", remarks_json(diagnosis)},
      {"log_faults", log_faults_json(diagnosis)},
      {"seconds", finite_or_null(diagnosis.seconds)},
      {"seed", diagnosis.seed}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";  // names of files may be no UTF-8
}

}  // namespace diagnose_program

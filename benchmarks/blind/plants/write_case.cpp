// Files of a case: what the tool is given, and the truth that it is not.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "case.hpp"
#include "text.hpp"

namespace plants {
namespace {

void write_text(const std::filesystem::path& file, const std::string& content) {
  const std::filesystem::path aside = file.string() + ".part";
  {
    std::ofstream stream(aside, std::ios::binary);
    stream << content;
    if (!stream.flush())
      throw std::runtime_error("cannot write " + aside.string() + ": is there space and permission?");
  }
  std::filesystem::rename(aside, file);
}

std::string csv(const System& system, const Recording& recording) {
  std::string out;
  for (const auto& [key, value] : recording.meta)
    if (key.front() != '_') out += "# " + key + ": " + text(value) + "\n";
  out += recording.time.empty() ? "step" : "t_s";
  for (const std::string& name : system.inputs) out += "," + name;
  for (const std::string& name : system.outputs) out += "," + name;
  out += "\n";
  for (std::size_t row = 0; row < recording.readings[0].size(); ++row) {
    out += recording.time.empty() ? std::to_string(row) : text(recording.time[row], "%.7g");
    for (const Column& column : recording.inputs) out += "," + text(column[row]);
    for (const Column& column : recording.readings)
      out += "," + (std::isfinite(column[row]) ? text(column[row], "%.7g") : std::string());
    out += "\n";
  }
  return out;
}

nlohmann::ordered_json effect_json(const Fault& fault, double strength) {
  nlohmann::ordered_json json{{"name", fault.name}, {"attached_to", fault.attached_to}, {"also_accepted", fault.also}};
  for (const auto& [name, place] : fault.equivalents)
    json["equivalents"].push_back({{"name", name}, {"attached_to", place}});
  json["same_formula"] = fault.same_formula;
  json["strength_alone"] = strength;
  json["parameters"] = nlohmann::ordered_json::array();
  for (const Number& number : fault.numbers)
    json["parameters"].push_back({{"name", number.name}, {"value", number.value}, {"unit", number.unit}});
  return json;
}

}  // namespace

void write_case(const Case& one, const std::filesystem::path& folder) {
  const std::filesystem::path own = folder / one.name;
  std::filesystem::create_directories(own);
  for (const Recording& recording : one.system.recordings) write_text(own / recording.name, csv(one.system, recording));
  write_text(own / "model.toml", one.system.model_toml(one.noise_shown));
}

void write_truth(const Case& one, const std::filesystem::path& file) {
  nlohmann::ordered_json json{{"schema", "surefoot.truth/1"}, {"case", one.name}, {"family", one.system.family}};
  json["machine"] = one.system.model_name;
  json["kind"] = name_of(one.kind);
  json["effects"] = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < one.faults.size(); ++k) {
    json["effects"].push_back(effect_json(one.faults[k], k < one.strength_each.size() ? one.strength_each[k] : 0));
  }
  json["parameters"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < one.system.parameters.size(); ++i) {
    const Parameter& p = one.system.parameters[i];
    json["parameters"].push_back({{"name", p.name},
                                  {"true", p.actual},
                                  {"nominal", p.nominal},
                                  {"unit", p.unit},
                                  {"fixed", p.fixed},
                                  {"calibrated_without_effects", one.calibrated[i]}});
  }
  for (std::size_t k = 0; k < one.system.outputs.size(); ++k)
    json["noise"][one.system.outputs[k]] = one.system.noise[k];
  json["noise_in_model"] = one.noise_shown;
  json["process_noise_per_step"] = one.system.process_noise;
  json["sensing"] = {{"noise_correlation", one.sensing.correlation},
                     {"resolution_in_noise", one.sensing.resolution},
                     {"missing_share", one.sensing.missing},
                     {"outlier", one.sensing.outlier}};
  json["true_model_rmse"] = one.actual_rmse;
  json["calibrated_nominal_rmse"] = one.calibrated_rmse;
  json["strength"] = one.strength();
  if (one.system.stepwise) {
    json["true_model_step_rmse"] = one.actual_step_rmse;
    json["calibrated_nominal_step_rmse"] = one.calibrated_step_rmse;
  }
  json["rmse_unit"] = "standard deviations of the measurement noise, full length";
  for (const RecordingError& error : one.errors) {
    json["per_recording"].push_back({{"recording", error.name},
                                     {"held_out", error.held_out},
                                     {"true_model_rmse", error.actual},
                                     {"calibrated_nominal_rmse", error.calibrated}});
    if (error.actual_with_outliers > 0)
      json["per_recording"].back()["true_model_rmse_with_outliers"] = error.actual_with_outliers;
  }
  write_text(file, json.dump(1) + "\n");
}

}  // namespace plants

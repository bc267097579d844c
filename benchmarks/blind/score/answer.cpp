#include "answer.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace score {
namespace {

using Json = nlohmann::json;

Json read_json(const std::filesystem::path& file) {
  std::ifstream stream(file);
  try {
    return Json::parse(stream);
  } catch (const Json::exception& error) {
    throw std::runtime_error(file.string() + ": not JSON, " + error.what());
  }
}

// A number, or not a number where the file has null or nothing.
double number(const Json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_number() ? at->get<double>() : std::numeric_limits<double>::quiet_NaN();
}

Effect read_effect(const Json& json) {
  Effect effect;
  effect.name = json.at("name");
  effect.attached_to = json.value("attached_to", json.value("place", ""));
  effect.also_accepted = json.value("also_accepted", std::vector<std::string>{});
  for (const Json& one : json.value("equivalents", Json::array()))
    effect.equivalents.emplace_back(one.at("name"), one.at("attached_to"));
  effect.same_formula = json.value("same_formula", false);
  for (const Json& one : json.value("parameters", Json::array()))
    effect.parameters[one.at("name")] = number(one, "value");
  // Amplitude and phase may be given as two parts.
  const auto sine = effect.parameters.find("sine"), cosine = effect.parameters.find("cosine");
  if (sine != effect.parameters.end() && cosine != effect.parameters.end()) {
    effect.parameters["amplitude"] = std::hypot(sine->second, cosine->second);
  }
  return effect;
}

// Every recording has coloured noise, so saying so is neither right nor wrong about the physics.
bool is_noise(const Effect& effect) {
  return effect.name == "correlated_noise" || effect.name == "speed_dependent_noise";
}

std::vector<Effect> read_effects(const Json& list) {
  std::vector<Effect> effects;
  for (const Json& one : list) effects.push_back(read_effect(one));
  std::erase_if(effects, is_noise);
  return effects;
}

Truth read_truth(const std::filesystem::path& file) {
  const Json json = read_json(file);
  Truth truth;
  truth.name = json.at("case");
  truth.family = json.at("family");
  truth.kind = json.at("kind");
  truth.effects = read_effects(json.at("effects"));
  truth.noise = json.at("noise").get<std::map<std::string, double>>();
  truth.strength = json.at("strength");
  for (const Json& one : json.at("per_recording")) {
    truth.rmse[one.at("recording")] = one.at("true_model_rmse");
    truth.floor[one.at("recording")] =
        one.value("true_model_rmse_with_outliers", one.at("true_model_rmse").get<double>());
    truth.calibrated[one.at("recording")] = one.at("calibrated_nominal_rmse");
  }
  return truth;
}

// Probabilities of whole structures: of a list of their own or, without one, beside the effects of choice and
// alternatives.
std::vector<Stated> read_structures(const Json& json) {
  std::vector<Stated> structures;
  const auto add = [&](const Json& effects, double probability) {
    if (std::isfinite(probability)) structures.push_back({read_effects(effects), probability});
  };
  for (const Json& one : json.value("structures", Json::array()))
    add(one.value("effects", Json::array()), number(one, "probability"));
  if (!structures.empty()) return structures;
  const auto of_effects = [](const Json& effects) {
    return effects.empty() ? std::numeric_limits<double>::quiet_NaN() : number(effects[0], "probability");
  };
  add(json.at("effects"), of_effects(json.at("effects")));
  for (const Json& one : json.value("alternatives", Json::array())) {
    const double own = number(one, "probability");
    add(one.at("effects"), std::isfinite(own) ? own : of_effects(one.at("effects")));
  }
  return structures;
}

Answer understand(const Json& json) {
  Answer answer;
  answer.verdict = json.at("verdict");
  std::ranges::replace(answer.verdict, '_', '-');
  answer.structures = read_structures(json);
  answer.noise_ratio = number(json, "noise_ratio");
  answer.effects = read_effects(json.at("effects"));
  for (const Json& one : json.value("alternatives", Json::array())) {
    answer.alternatives.push_back({read_effects(one.at("effects")), one.value("indistinguishable", false)});
  }
  const Json recordings = json.value("recordings", Json::object());
  answer.test = recordings.value("test", std::vector<std::string>{});
  const Json mismatch = json.value("mismatch", Json::object());
  for (const Json& channel : mismatch.value("channels", Json::array())) {
    answer.rmse_after[channel.at("output")] = number(channel, "rmse_after");
  }
  const Json held_out = json.value("fit", Json::object()).value("heldout", Json::object());
  answer.before = number(held_out, "rmse_before");
  answer.after = number(held_out, "rmse_after");
  answer.seconds = number(json, "seconds");
  answer.complete = json.value("complete", true);
  if (answer.verdict == "missing-physics" && answer.effects.empty()) answer.verdict = "parameters-only";
  return answer;
}

}  // namespace

std::vector<Truth> read_truths(const std::filesystem::path& folder) {
  std::vector<Truth> truths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".json") truths.push_back(read_truth(entry.path()));
  std::ranges::sort(truths, {}, &Truth::name);
  return truths;
}

std::optional<Answer> read_answer(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  const Json json = read_json(file);
  try {
    return understand(json);
  } catch (const Json::exception& error) {
    throw std::runtime_error(file.string() + ": not a diagnosis, " + error.what());
  }
}

}  // namespace score

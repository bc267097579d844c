// concealed_robots_score: what surefoot-diagnose said of blind robots, against the truth.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

using nlohmann::json;

json read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return stream ? json::parse(stream, nullptr, false) : json();
}

// At the place itself, or at all joints by way of each group.
bool same_place(const std::string& said, const std::string& truth) {
  return said == truth || (truth == "all" && said == "all joints");
}

struct Match {
  bool found = false, tied = false, invisible = false;  // declared to show at no size
  double error = NAN;  // of the parameter, relative
  std::size_t used = 0;
};

Match match(const json& truth, const json& diagnosis, std::vector<char>& used) {
  Match result;
  const std::string effect = truth["effect"], place = truth["place"];
  if (effect == "columns_swapped") {
    for (const json& fault : diagnosis["log_faults"]) result.found = result.found || fault["kind"] == effect;
    return result;
  }
  std::size_t places = 0;
  for (std::size_t i = 0; i < diagnosis["effects"].size(); ++i) {
    const json& one = diagnosis["effects"][i];
    if (one["name"] != effect) continue;
    const std::string said = one["attached_to"], form = one.value("form", "");
    const bool group_of_all = place == "all" && form == "group";
    if (!same_place(said, place) && !group_of_all) continue;
    used[i] = 1;
    places += 1;
    result.found = true;
    const double value = one["parameters"][0]["value"], expected = truth["value"];
    if (one["parameters"][0]["name"] == truth["parameter"])
      result.error = std::abs(value - expected) / std::abs(expected);
  }
  if (result.found) return result;
  for (const json& other : diagnosis["alternatives"]) {
    for (const json& one : other["effects"])
      result.tied = result.tied || (one["name"] == effect && same_place(one["attached_to"], place));
  }
  for (const json& one : diagnosis["robot"].value("invisible", json::array()))
    result.invisible = result.invisible || (!result.tied && one["effect"] == effect && one["joint"] == place);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs(
        "usage: concealed_robots_score CASES RESULTS: the folder of concealed_robots, and of diagnoses by case\n",
        stderr);
    return 2;
  }
  const std::filesystem::path cases = argv[1], results = argv[2];
  std::size_t hidden = 0, found = 0, tied = 0, invisible = 0, none = 0, false_alarms = 0, extra = 0, complete = 0,
              robots = 0, contradicted = 0, replays = 0, replayed = 0;
  std::vector<double> errors;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(cases / "truth")) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    const json truth = read(file), diagnosis = read(results / file.stem() / "diagnosis.json");
    if (!diagnosis.is_object()) {
      std::printf("%s: no diagnosis\n", file.stem().c_str());
      continue;
    }
    ++robots;
    std::vector<char> used(diagnosis["effects"].size(), 0);
    std::string line = std::string(truth["family"]) + " " + std::string(truth["drive"]) + " " +
                       std::string(diagnosis["verdict"]) + ":";
    bool all = true;
    for (const json& one : truth["hidden"]) {
      const Match result = match(one, diagnosis, used);
      ++hidden;
      found += result.found ? 1 : 0;
      tied += result.tied ? 1 : 0;
      invisible += result.invisible ? 1 : 0;
      all = all && (result.found || result.tied || result.invisible);
      if (std::isfinite(result.error)) errors.push_back(result.error);
      char text[200];
      std::snprintf(text, sizeof text, " %s@%s=%.3g %s(%.0f %%)", std::string(one["effect"]).c_str(),
                    std::string(one["place"]).c_str(), double(one["value"]),
                    result.found       ? "found"
                    : result.tied      ? "tied"
                    : result.invisible ? "invisible"
                                       : "MISSED",
                    100 * result.error);
      line += text;
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (used[i] != 0) continue;
      const json& one = diagnosis["effects"][i];
      ++extra;
      char text[200];
      std::snprintf(text, sizeof text, " +%s@%s=%.3g", std::string(one["name"]).c_str(),
                    std::string(one["attached_to"]).c_str(), double(one["parameters"][0]["value"]));
      line += text;
    }
    if (truth["hidden"].empty()) {
      ++none;
      false_alarms += diagnosis["verdict"] != "adequate" ? 1 : 0;
    } else {
      complete += all && std::find(used.begin(), used.end(), 0) == used.end() ? 1 : 0;
    }
    const json& ratio = diagnosis["noise_ratio"];
    contradicted += ratio.is_number() && double(ratio) > 1.5 && diagnosis["verdict"] != "unexplained" ? 1 : 0;
    const json &after = diagnosis["robot"]["rmse_after"], &again = diagnosis["robot"]["rmse_replayed"];
    if (after.is_number() && again.is_number()) {
      constexpr double same = 0.02;  // of the stated error
      ++replays;
      replayed += std::abs(double(again) / double(after) - 1) <= same ? 1 : 0;
    }
    std::printf("%s %s (%.0f s, noise ratio %.2f)\n", file.stem().c_str(), line.c_str(), double(diagnosis["seconds"]),
                ratio.is_number() ? double(ratio) : NAN);
  }
  std::sort(errors.begin(), errors.end());
  std::printf(
      "robots %zu; hidden %zu: found %zu, in a stated tie %zu, declared invisible %zu; without fault and without "
      "extras %zu of %zu; extras "
      "%zu; "
      "false alarms %zu of %zu; verdicts against the noise floor %zu; parameters off by %.1f %% in the median; "
      "replayed to the stated error %zu of %zu\n",
      robots, hidden, found, tied, invisible, complete, robots - none, extra, false_alarms, none, contradicted,
      errors.empty() ? NAN : 100 * errors[errors.size() / 2], replayed, replays);
}

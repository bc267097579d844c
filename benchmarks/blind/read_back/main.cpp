// concealed_read_back: compares the errors of diagnoses with those of their augmented models, read back and diagnosed
// again with no further effects.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* usage =
    "usage: concealed_read_back FOUND AGAIN    each holds NAME/diagnosis.json; AGAIN of FOUND's augmented.toml\n";
constexpr double same = 0.01;   // errors that differ by no more are the same
constexpr double exact = 1e-6;  // by which a fit may be worse than its start: rounding

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double number(const Json& value) { return value.is_number() ? value.get<double>() : unknown; }

Json read_json(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return Json::parse(stream);
}

/// Errors of one case, before and after it was read back.
struct Comparison {
  std::string name;
  std::size_t effects = 0;
  bool complete = true;
  double fitted = unknown;     // of fits to all recordings: again over found
  double held_out = unknown;   // of the output that differs most: again over found
  double own_start = unknown;  // of the first diagnosis: fit with effects over that without
};

/// Of all outputs, the ratio of held-out errors that is furthest from 1.
double held_out_ratio(const Json& found, const Json& again) {
  double worst = unknown;
  const Json &before = found.at("mismatch").at("channels"), &after = again.at("mismatch").at("channels");
  for (std::size_t k = 0; k < std::min(before.size(), after.size()); ++k) {
    const double ratio = number(after[k].at("rmse_calibrated")) / number(before[k].at("rmse_after"));
    if (!std::isfinite(worst) || std::abs(std::log(ratio)) > std::abs(std::log(worst))) worst = ratio;
  }
  return worst;
}

Comparison compare(const std::string& name, const Json& found, const Json& again) {
  const Json &before = found.at("fit").at("train"), &after = again.at("fit").at("train");
  Comparison one{name};
  one.effects = found.at("effects").size();
  one.complete = found.at("complete").get<bool>() && again.at("complete").get<bool>();
  one.fitted = number(after.at("rmse_before")) / number(before.at("rmse_after"));
  one.held_out = held_out_ratio(found, again);
  one.own_start = number(before.at("rmse_after")) / number(before.at("rmse_before"));
  return one;
}

void print(const std::vector<Comparison>& all) {
  std::size_t same_fitted = 0, same_held_out = 0, not_worse = 0;
  std::printf("%-20s %8s %10s %10s %10s\n", "case", "effects", "fitted", "held out", "own start");
  for (const Comparison& one : all) {
    const bool fitted = std::abs(one.fitted - 1) <= same, held_out = std::abs(one.held_out - 1) <= same;
    const bool better = one.own_start <= 1 + exact && one.fitted <= 1 + same;
    same_fitted += fitted ? 1 : 0;
    same_held_out += held_out ? 1 : 0;
    not_worse += better ? 1 : 0;
    std::printf("%-20s %8zu %10.4f %10.4f %10.4f%s%s\n", one.name.c_str(), one.effects, one.fitted, one.held_out,
                one.own_start, fitted && held_out && better ? "" : "  differs", one.complete ? "" : "  (not finished)");
  }
  std::printf(
      "\n%zu cases: error of the fit the same within %g %% in %zu, held out in %zu; no fit worse than its start in "
      "%zu\n",
      all.size(), 100 * same, same_fitted, same_held_out, not_worse);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 3) {
      std::fputs(usage, stderr);
      return 2;
    }
    std::vector<fs::path> folders;
    for (const auto& entry : fs::directory_iterator(argv[2])) folders.push_back(entry.path().filename());
    std::ranges::sort(folders);
    std::vector<Comparison> all;
    for (const fs::path& name : folders) {
      const fs::path found = argv[1] / name / "diagnosis.json", again = argv[2] / name / "diagnosis.json";
      if (fs::exists(found) && fs::exists(again))
        all.push_back(compare(name.string(), read_json(found), read_json(again)));
    }
    print(all);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "concealed_read_back: %s\n", error.what());
    return 1;
  }
}

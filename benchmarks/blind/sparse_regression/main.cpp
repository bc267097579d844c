// concealed_sparse_regression: a plain baseline for the blind benchmark. Calibrates the nominal parameters, regresses
// what remains of the rates on a library of terms with sequential thresholding, and names the effects that the terms
// stand for. Same command line and diagnosis.json as surefoot-diagnose, as far as scoring needs them.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "calibrate.hpp"
#include "identify.hpp"
#include "load_case.hpp"

namespace {

using Json = nlohmann::ordered_json;
using plants::Column;
using plants::Recording;
using plants::Values;

constexpr const char* usage =
    "usage: concealed_sparse_regression --model MODEL.toml --out DIR [--quiet] [--threads 1] RECORDING.csv...\n";

struct Options {
  std::filesystem::path model, out;
  std::vector<std::filesystem::path> recordings;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const bool takes_value = option == "--model" || option == "--out" || option == "--threads";
    if (takes_value && ++i >= argc) throw std::invalid_argument(option + " needs a value");
    if (option == "--model") {
      options.model = argv[i];
    } else if (option == "--out") {
      options.out = argv[i];
    } else if (!takes_value && option != "--quiet") {
      if (option.starts_with("--")) throw std::invalid_argument("unknown option " + option);
      options.recordings.emplace_back(option);
    }
  }
  if (options.model.empty() || options.out.empty()) throw std::invalid_argument("--model and --out are needed");
  if (options.recordings.size() < 3) throw std::invalid_argument("at least three recordings are needed");
  return options;
}

// Per output, in its own unit, over whole recordings.
Values simulation_errors(const sparse::Machine& machine, const Values& parameters, const Values& coefficients,
                         std::span<const Recording> recordings) {
  Values squares(machine.output_state.size()), counts(squares.size());
  for (const Recording& recording : recordings) {
    const std::vector<Column> outputs = sparse::simulate(machine, parameters, coefficients, recording);
    for (std::size_t k = 0; k < outputs.size(); ++k)
      for (std::size_t row = 0; row < outputs[k].size(); ++row) {
        const double off = recording.readings[k][row] - outputs[k][row];
        if (!std::isfinite(off)) continue;
        squares[k] += off * off;
        counts[k] += 1;
      }
  }
  for (std::size_t k = 0; k < squares.size(); ++k) squares[k] = std::sqrt(squares[k] / std::max(counts[k], 1.0));
  return squares;
}

double in_noise(const Values& errors, const Values& noise) {
  double sum = 0;
  for (std::size_t k = 0; k < errors.size(); ++k) sum += errors[k] * errors[k] / (noise[k] * noise[k]);
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

// What the coefficient of a term is called where it is a parameter of the effect itself.
std::string parameter_of(const std::string& effect) {
  static const std::map<std::string, std::string> names{
      {"constant_force", "force"},         {"coulomb_friction", "level"},
      {"gravity_offset", "level"},         {"leak", "rate"},
      {"viscous_friction", "coefficient"}, {"quadratic_drag", "coefficient"},
      {"cubic_stiffness", "stiffness"},    {"constant_rate", "rate"},
      {"cross_coupling", "gain"}};
  const auto at = names.find(effect);
  return at == names.end() ? "weight_of_term" : at->second;
}

// Each effect once, the most important term first.
Json effects_json(const sparse::Machine& machine, const sparse::Found& found) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < machine.terms.size(); ++k)
    if (found.coefficients[k] != 0) order.push_back(k);
  std::ranges::sort(order, std::greater{}, [&](std::size_t k) { return found.importance[k]; });
  Json effects = Json::array();
  std::vector<std::string> said;
  for (const std::size_t k : order) {
    const sparse::Term& term = machine.terms[k];
    if (std::ranges::find(said, term.effect + term.attached_to) != said.end()) continue;
    said.push_back(term.effect + term.attached_to);
    effects.push_back({{"name", term.effect},
                       {"attached_to", term.attached_to},
                       {"parameters", {{{"name", parameter_of(term.effect)}, {"value", found.coefficients[k]}}}}});
  }
  return effects;
}

Json diagnose(const Options& options) {
  const auto started = std::chrono::steady_clock::now();
  const plants::System system = sparse::load_case(options.model, options.recordings);
  const std::size_t fitted = system.recordings.size() * 7 / 10;
  const std::span<const Recording> all(system.recordings), fit = all.first(fitted), test = all.subspan(fitted);
  const Values parameters = plants::calibrate(system, {}, fit, {2, true, system.stepwise, nullptr});

  sparse::Machine machine = sparse::make_machine(system);
  sparse::add_terms(machine, system, sparse::sizes_of_motion(machine, parameters, fit));
  const sparse::Found found = sparse::identify(system, machine, parameters, fit, test);
  const Values before = simulation_errors(machine, parameters, {}, test);
  const Values after = simulation_errors(machine, parameters, found.coefficients, test);

  Json json{{"schema", "surefoot.diagnosis/1"}, {"model", system.model_name}, {"complete", true}};
  json["verdict"] = found.significant ? "missing-physics" : "parameters-only";
  json["recordings"]["test"] = Json::array();
  for (const Recording& recording : test) json["recordings"]["test"].push_back(recording.name);
  for (std::size_t k = 0; k < before.size(); ++k) {
    json["mismatch"]["channels"].push_back(
        {{"output", system.outputs[k]}, {"rmse_calibrated", before[k]}, {"rmse_after", after[k]}});
  }
  json["effects"] = effects_json(machine, found);
  json["alternatives"] = Json::array();
  json["fit"]["heldout"] = {{"rmse_before", in_noise(before, system.noise)},
                            {"rmse_after", in_noise(after, system.noise)}};
  json["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return json;
}

void write(const std::filesystem::path& file, const Json& json) {
  std::filesystem::create_directories(file.parent_path());
  const std::filesystem::path aside = file.string() + ".part";
  {
    std::ofstream stream(aside);
    stream << json.dump(1) << "\n";
    if (!stream.flush())
      throw std::runtime_error(aside.string() + ": cannot be written; is there space and permission?");
  }
  std::filesystem::rename(aside, file);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = parse(argc, argv);
    write(options.out / "diagnosis.json", diagnose(options));
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "concealed_sparse_regression: %s\n%s", error.what(), usage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "concealed_sparse_regression: %s\n", error.what());
    return 2;
  }
}

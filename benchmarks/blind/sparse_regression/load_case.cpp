#include "load_case.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace sparse {
namespace {

using plants::Recording;
using plants::System;

std::ifstream open(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be opened");
  return stream;
}

// The number after `key = ` in a line, or `otherwise`.
double entry(const std::string& line, const std::string& key, double otherwise) {
  const std::size_t at = line.find(key + " = ");
  return at == std::string::npos ? otherwise : std::stod(line.substr(at + key.size() + 3));
}

System read_model(const std::filesystem::path& file) {
  System system;
  std::ifstream stream = open(file);
  std::string section;
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("[", 0) == 0) section = line;
    const std::size_t equals = line.find(" = ");
    if (line.rfind("name ", 0) == 0)
      system.model_name = line.substr(line.find('"') + 1, line.rfind('"') - line.find('"') - 1);
    if (equals == std::string::npos) continue;
    if (section == "[inputs]")
      system.inputs.push_back(line.substr(line.find('"') + 1, line.rfind('"') - line.find('"') - 1));
    if (section == "[outputs]") {
      system.outputs.push_back(line.substr(0, equals));
      system.noise.push_back(entry(line, "noise", 0));
    }
    if (section != "[parameters]") continue;
    plants::Parameter p;
    p.name = line.substr(0, equals);
    p.nominal = p.actual = entry(line, "value", 0);
    p.low = entry(line, "min", p.nominal);
    p.high = entry(line, "max", p.nominal);
    p.fixed = line.find("fixed = true") != std::string::npos;
    system.parameters.push_back(p);
  }
  return system;
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> list;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) list.push_back(cell);
  if (line.ends_with(',')) list.emplace_back();
  return list;
}

Recording read_recording(const std::filesystem::path& file, const System& system) {
  Recording recording;
  recording.name = file.filename().string();
  recording.inputs.resize(system.inputs.size());
  recording.readings.resize(system.outputs.size());
  std::ifstream stream = open(file);
  std::vector<std::string> header;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.rfind("# ", 0) == 0) {
      const std::size_t colon = line.find(": ");
      recording.meta.emplace_back(line.substr(2, colon - 2), std::stod(line.substr(colon + 2)));
      continue;
    }
    const std::vector<std::string> row = cells(line);
    if (header.empty()) {
      header = row;
      continue;
    }
    if (row.size() != header.size()) {
      throw std::runtime_error(file.string() + ", line " + std::to_string(number) + ": " + std::to_string(row.size()) +
                               " cells, the header has " + std::to_string(header.size()));
    }
    const auto value = [&](const std::string& column) {
      const auto at = std::ranges::find(header, column);
      if (at == header.end()) throw std::runtime_error(file.string() + ": no column " + column);
      const std::string& cell = row[static_cast<std::size_t>(at - header.begin())];
      return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(cell);
    };
    if (header[0] == "t_s") recording.time.push_back(value("t_s"));
    for (std::size_t k = 0; k < system.inputs.size(); ++k) recording.inputs[k].push_back(value(system.inputs[k]));
    for (std::size_t k = 0; k < system.outputs.size(); ++k) recording.readings[k].push_back(value(system.outputs[k]));
  }
  if (recording.readings[0].size() < 2) throw std::runtime_error(file.string() + ": fewer than two rows");
  for (const plants::Column& column : recording.readings) recording.outliers.emplace_back(column.size(), false);
  return recording;
}

// The constants of a carriage as its simulator expects them.
void complete_carriage(System& system) {
  const auto has = [&](const std::string& name) {
    return std::ranges::find(system.parameters, name, &plants::Parameter::name) != system.parameters.end();
  };
  const bool weighed = !has("mass");
  if (!has("damping")) system.parameters.insert(system.parameters.begin() + 1, {"damping", "N s/m", 0, 0, 0, 0, true});
  if (weighed) system.parameters.push_back({"mass", "kg", 1, 1, 1, 1, true});
  for (Recording& recording : system.recordings) {
    const double mass = weighed ? recording.meta.at(0).second : 0;
    recording.meta = {{"_mass", mass}, {"_top", 1}};
  }
}

// Noise where the model file does not state it: from how far readings are off the line through their neighbours.
void estimate_noise(System& system) {
  for (std::size_t k = 0; k < system.noise.size(); ++k) {
    if (system.noise[k] > 0) continue;
    std::vector<double> bends;
    for (const Recording& recording : system.recordings)
      for (std::size_t i = 2; i < recording.readings[k].size(); ++i) {
        const plants::Column& y = recording.readings[k];
        const double bend = std::abs(y[i] - 2 * y[i - 1] + y[i - 2]) / std::sqrt(6.0);
        if (std::isfinite(bend)) bends.push_back(bend);
      }
    system.noise[k] = k < 2 ? 0.01 : 0.035;  // by tape, if there is one reading per recording
    if (bends.size() < 100) continue;
    std::ranges::nth_element(bends, bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2));
    system.noise[k] = std::max(bends[bends.size() / 2] / 0.6745, 1e-6);
  }
}

}  // namespace

System load_case(const std::filesystem::path& model, const std::vector<std::filesystem::path>& recordings) {
  System system = read_model(model);
  for (const auto& file : recordings) system.recordings.push_back(read_recording(file, system));
  const std::size_t outputs = system.outputs.size();
  for (Recording& recording : system.recordings) recording.initial = {0, 0, 0};
  estimate_noise(system);
  if (system.model_name == "servo pendulum") {
    system.family = "servo";
    system.simulate = plants::servo_simulation(outputs > 1);
  } else if (system.model_name == "carriage with spring") {
    system.family = "carriage";
    complete_carriage(system);
    system.simulate = plants::carriage_simulation();
  } else if (system.model_name == "two tanks") {
    system.family = "tanks";
    // An upper level that is not measured starts somewhere; in rest with the lower one is the best guess.
    for (Recording& recording : system.recordings)
      recording.initial = {recording.readings[0][0], recording.readings[0][0], 0};
    system.simulate = plants::tanks_simulation(outputs > 1);
  } else if (system.model_name.rfind("walk", 0) == 0) {
    system.family = "walk";
    system.final_only = system.model_name != "walk";
    system.stepwise = !system.final_only;
    system.process_noise = {0.002, 0.002, 0.012};
    system.simulate = plants::walk_simulation(system.process_noise);
  } else {
    throw std::runtime_error(model.string() + ": the baseline does not know the model " + system.model_name);
  }
  return system;
}

}  // namespace sparse

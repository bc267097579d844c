#include "motion_file.hpp"

#include <Eigen/Cholesky>
#include <nlohmann/json.hpp>
#include <utility>

#include "json_fields.hpp"
#include "surefoot/core/binary.hpp"

namespace calibrate_program {
namespace {

using detail::Fields;
using detail::Json;
using detail::member;

Json to_json(const surefoot::Vec<3>& v) { return Json{v[0], v[1], v[2]}; }

Json to_json(const std::vector<EvaluatedModel>& models) {
  Json list = Json::array();
  for (const EvaluatedModel& model : models) {
    Json entry{{"model", model.model}, {"parameters", model.parameters}, {"position_m", model.position}};
    if (std::isfinite(model.position_error)) entry["position_standard_error_m"] = model.position_error;
    if (std::isfinite(model.heading)) entry["heading_rad"] = model.heading;
    entry["chosen"] = model.chosen;
    list.push_back(std::move(entry));
  }
  return list;
}

Json parameters_to_json(ModelKind kind, const Eigen::VectorXd& values, const Eigen::MatrixXd& covariance) {
  Json list = Json::array();
  Eigen::Index i = 0;
  for (const surefoot::ModelParameter& info : default_model(kind).parameter_info()) {
    list.push_back({{"name", info.name},
                    {"value", values[i]},
                    {"standard_error", std::sqrt(covariance(i, i))},
                    {"unit", info.unit}});
    ++i;
  }
  return list;
}

void parameters_from_json(const Fields& root, MotionFile& file) {
  const auto infos = default_model(file.kind).parameter_info();
  const auto n = static_cast<Eigen::Index>(infos.size());
  const Json& list = root.at("parameters");
  if (!list.is_array() || list.size() != static_cast<std::size_t>(n)) {
    root.fail("parameters", "a list of the " + std::to_string(n) + " coefficients of this model is expected");
  }
  file.parameters.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const surefoot::ModelParameter& info = infos[at];
    const std::string field = "parameters[" + std::to_string(i) + "]";
    const Json& entry = list[at];
    if (!entry.is_object() || member(entry, "name") != info.name || member(entry, "unit") != info.unit) {
      root.fail(field, "the coefficient \"" + std::string(info.name) + "\" in \"" + std::string(info.unit) +
                           "\" is expected here");
    }
    file.parameters[i] = root.number_of(member(entry, "value"), field + ".value", info.low, info.high);
  }
  file.model = embedded(file.kind, file.parameters);
  file.covariance.resize(n, n);
  const Json& rows = root.at("covariance");
  if (!rows.is_array() || rows.size() != static_cast<std::size_t>(n)) {
    root.fail("covariance", std::to_string(n) + " rows are expected");
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    file.covariance.row(i) = root.numbers_of(rows[static_cast<std::size_t>(i)], "covariance", n, -1e6, 1e6);
  }
  const bool symmetric = file.covariance.isApprox(file.covariance.transpose(), 1e-6);
  if (!symmetric || Eigen::LLT<Eigen::MatrixXd>(file.covariance).info() != Eigen::Success) {
    root.fail("covariance", "is not symmetric and positive definite");
  }
}

std::vector<EvaluatedModel> evaluated_from_json(const Fields& root, const std::string& field) {
  std::vector<EvaluatedModel> models;
  if (!root.has(field)) return models;
  if (!root.at(field).is_array()) root.fail(field, "a list is expected");
  for (const Json& json : root.at(field)) {
    if (!json.is_object()) root.fail(field, "a list of objects is expected");
    const auto number = [&](const char* key, double missing) {
      return json.contains(key) ? root.number_of(json[key], field + "." + key, 0, 1e9) : missing;
    };
    const Json& name = member(json, "model");
    if (!name.is_string()) root.fail(field + ".model", "text is expected");
    models.push_back({.model = name.get<std::string>(),
                      .parameters = static_cast<int>(number("parameters", 0)),
                      .position = number("position_m", 0),
                      .position_error = number("position_standard_error_m", NAN),
                      .heading = number("heading_rad", NAN),
                      .chosen = member(json, "chosen") == Json(true)});
  }
  return models;
}

surefoot::MotionNoise noise_from_json(const Fields& fields) {
  surefoot::MotionNoise noise;
  const std::string shape = fields.text("shape");
  if (shape != "uniform" && shape != "gaussian") fields.fail("shape", "\"uniform\" or \"gaussian\" is expected");
  noise.shape = shape == "uniform" ? surefoot::NoiseShape::uniform : surefoot::NoiseShape::gaussian;
  noise.constant = fields.numbers("constant", 3, 0, 1e3);
  noise.per_speed = fields.numbers("per_speed", 3, 0, 1e3);
  noise.per_acceleration = fields.numbers("per_acceleration", 3, 0, 1e3);
  noise.scale = fields.numbers("scale", 3, 1e-9, 1e6);
  return noise;
}

}  // namespace

std::string motion_file_text(const MotionFile& file) {
  Json json{{"schema", "surefoot.motion/1"},
            {"model", file_name_of(file.kind)},
            {"meaning",
             "displacement of a cycle (dx forward [m], dy left [m], dt counterclockwise [rad]) from the command of the "
             "cycle and of the last one, each times steps_per_cycle"},
            {"steps_per_cycle", file.steps_per_cycle}};
  json["parameters"] = parameters_to_json(file.kind, file.parameters, file.covariance);
  json["noise"] = {
      {"meaning",
       "standard deviation of dx, dy, dt in a cycle [m, m, rad]: constant + per_speed * |command / scale| + "
       "per_acceleration * |change of command / scale|"},
      {"shape", surefoot::name_of(file.noise.shape)},
      {"shape_known", file.noise_shape_known},
      {"constant", to_json(file.noise.constant)},
      {"per_speed", to_json(file.noise.per_speed)},
      {"per_acceleration", to_json(file.noise.per_acceleration)},
      {"scale", to_json(file.noise.scale)}};
  json["measured_with"] = {{"position_m", file.accuracy.position},
                           {"heading_rad", file.accuracy.heading},
                           {"heading_tolerance_rad", file.accuracy.heading_tolerance}};
  json["method"] = file.method;
  json["sequences"] = file.sequences;
  json["readings"] = file.readings;
  json["seed"] = file.seed;
  if (!file.heldout.empty()) json["heldout"] = to_json(file.heldout);
  if (!file.test.empty()) json["test"] = to_json(file.test);
  json["covariance"] = Json::array();
  for (const auto& row : file.covariance.rowwise()) {
    json["covariance"].push_back(std::vector<double>(row.begin(), row.end()));
  }
  return json.dump(1) + "\n";
}

MotionFile parse_motion_file(std::string_view text, const std::string& name) {
  // What is nested deeper than anything known is left out: the parser copies values, and deep ones overflow the stack.
  const auto known = [](int depth, Json::parse_event_t, const Json&) { return depth <= 16; };
  const Json json = Json::parse(text, known, false);
  if (json.is_discarded()) {
    throw surefoot::MotionError(name + ": this is not JSON; a file that surefoot-calibrate wrote is expected");
  }
  const Fields root(json, name, "");
  if (root.text("schema") != "surefoot.motion/1") root.fail("schema", "only \"surefoot.motion/1\" is known");
  MotionFile file;
  const auto kind = model_named(root.text("model"));
  if (!kind) root.fail("model", "\"proportional\", \"simple\", \"full\" or \"previous-order\" is expected");
  file.kind = *kind;
  parameters_from_json(root, file);
  const Fields noise = root.object("noise");
  file.noise = noise_from_json(noise);
  file.noise_shape_known = noise.flag("shape_known");
  const Fields accuracy = root.object("measured_with");
  file.accuracy = {.position = accuracy.number("position_m", 0, 1e3),
                   .heading = accuracy.number("heading_rad", 0, 10),
                   .heading_tolerance = accuracy.number("heading_tolerance_rad", 0, 3.2)};
  file.steps_per_cycle = root.number("steps_per_cycle", 1e-6, 1e6);
  file.method = root.text("method");
  file.sequences = root.count("sequences");
  file.readings = root.count("readings");
  file.seed = root.count("seed");
  file.heldout = evaluated_from_json(root, "heldout");
  file.test = evaluated_from_json(root, "test");
  return file;
}

MotionFile read_motion_file(const std::filesystem::path& path) {
  const surefoot::Bytes bytes = surefoot::read_file(path);
  return parse_motion_file({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.filename().string());
}

void write_motion_file(const std::filesystem::path& path, const MotionFile& file) {
  surefoot::write_file_atomically(path, motion_file_text(file));
}

}  // namespace calibrate_program

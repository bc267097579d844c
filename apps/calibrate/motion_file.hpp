// The file motion.json, "surefoot.motion/1": a calibrated motion model, how well it is known, and the noise of the
// walk. Needs nothing but the library and nlohmann-json, so that any program may read it.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model_kind.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace calibrate_program {

/// Errors of final poses of sequences that a model was not fitted to.
struct EvaluatedModel {
  std::string model;
  int parameters = 0;           // 0: the commands as they are
  double position = 0;          // root mean square [m]
  double position_error = NAN;  // its standard error [m]; NaN: not known
  double heading = NAN;         // root mean square [rad]; NaN: not measured
  bool chosen = false;
};

struct MotionFile {
  ModelKind kind = ModelKind::full;
  surefoot::PreviousCommandCorrection model;  // any kind; coefficients it does not have are 0
  Eigen::VectorXd parameters;                 // of the kind's own vector
  Eigen::MatrixXd covariance;                 // of those
  surefoot::MotionNoise noise;
  bool noise_shape_known = false;
  surefoot::PoseAccuracy accuracy;  // of the poses it was calibrated from
  double steps_per_cycle = 1;       // a perfect robot moves by this times its command in a cycle
  std::string method;               // "published", "likelihood" or "update"
  std::size_t sequences = 0;        // calibrated from
  std::size_t readings = 0;         // coordinates measured in them
  std::uint64_t seed = 1;
  std::vector<EvaluatedModel> heldout;  // by cross-validation
  std::vector<EvaluatedModel> test;     // on held-out sequences
};

namespace detail {

using Json = nlohmann::ordered_json;

/// Null if the object has no such member. No copy: the copy of a value that is nested deeply overflows the stack.
inline const Json& member(const Json& object, const char* name) {
  static const Json nothing;
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

inline Json to_json(const surefoot::Vec<3>& v) { return Json{v[0], v[1], v[2]}; }

inline Json to_json(const std::vector<EvaluatedModel>& models) {
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

/// Fields of one object, with errors that name file and field.
class Fields {
 public:
  Fields(const Json& json, std::string file, std::string path)
      : json_(json), file_(std::move(file)), path_(std::move(path)) {
    if (!json_.is_object()) fail("", "an object { } is expected");
  }

  [[noreturn]] void fail(const std::string& field, const std::string& what) const {
    std::string place = path_ + field;
    throw surefoot::MotionError(file_ + ": " + (place.empty() ? "" : "\"" + place + "\": ") + what +
                                "; let surefoot-calibrate write the file again");
  }

  bool has(const std::string& field) const { return json_.contains(field); }

  const Json& at(const std::string& field) const {
    const auto found = json_.find(field);
    if (found == json_.end()) fail(field, "is missing");
    return *found;
  }

  Fields object(const std::string& field) const { return {at(field), file_, path_ + field + "."}; }

  std::string text(const std::string& field) const {
    if (!at(field).is_string()) fail(field, "text is expected");
    return at(field).get<std::string>();
  }

  double number(const std::string& field, double low, double high) const {
    return number_of(at(field), field, low, high);
  }

  bool flag(const std::string& field) const {
    if (!at(field).is_boolean()) fail(field, "true or false is expected");
    return at(field).get<bool>();
  }

  std::uint64_t count(const std::string& field) const {
    if (!at(field).is_number_unsigned()) fail(field, "a whole number from 0 on is expected");
    return at(field).get<std::uint64_t>();
  }

  Eigen::VectorXd numbers(const std::string& field, Eigen::Index size, double low, double high) const {
    return numbers_of(at(field), field, size, low, high);
  }

  Eigen::VectorXd numbers_of(const Json& list, const std::string& field, Eigen::Index size, double low,
                             double high) const {
    if (!list.is_array() || list.size() != static_cast<std::size_t>(size)) {
      fail(field, "a list of " + std::to_string(size) + " numbers is expected");
    }
    Eigen::VectorXd result(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      result[i] = number_of(list[static_cast<std::size_t>(i)], field, low, high);
    }
    return result;
  }

  double number_of(const Json& value, const std::string& field, double low, double high) const {
    const double number = value.is_number() ? value.get<double>() : NAN;
    if (!(number >= low && number <= high))
      fail(field, "a number from " + shown(low) + " to " + shown(high) + " is expected");
    return number;
  }

 private:
  static std::string shown(double value) { return Json(value).dump(); }

  const Json& json_;
  std::string file_, path_;
};

inline Json parameters_to_json(ModelKind kind, const Eigen::VectorXd& values, const Eigen::MatrixXd& covariance) {
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

inline void parameters_from_json(const Fields& root, MotionFile& file) {
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

inline std::vector<EvaluatedModel> evaluated_from_json(const Fields& root, const std::string& field) {
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

inline surefoot::MotionNoise noise_from_json(const Fields& fields) {
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

}  // namespace detail

inline std::string motion_file_text(const MotionFile& file) {
  using detail::Json;
  Json json{{"schema", "surefoot.motion/1"},
            {"model", file_name_of(file.kind)},
            {"meaning",
             "displacement of a cycle (dx forward [m], dy left [m], dt counterclockwise [rad]) from the command of the "
             "cycle and of the last one, each times steps_per_cycle"},
            {"steps_per_cycle", file.steps_per_cycle}};
  json["parameters"] = detail::parameters_to_json(file.kind, file.parameters, file.covariance);
  json["noise"] = {
      {"meaning",
       "standard deviation of dx, dy, dt in a cycle [m, m, rad]: constant + per_speed * |command / scale| + "
       "per_acceleration * |change of command / scale|"},
      {"shape", surefoot::name_of(file.noise.shape)},
      {"shape_known", file.noise_shape_known},
      {"constant", detail::to_json(file.noise.constant)},
      {"per_speed", detail::to_json(file.noise.per_speed)},
      {"per_acceleration", detail::to_json(file.noise.per_acceleration)},
      {"scale", detail::to_json(file.noise.scale)}};
  json["measured_with"] = {{"position_m", file.accuracy.position},
                           {"heading_rad", file.accuracy.heading},
                           {"heading_tolerance_rad", file.accuracy.heading_tolerance}};
  json["method"] = file.method;
  json["sequences"] = file.sequences;
  json["readings"] = file.readings;
  json["seed"] = file.seed;
  if (!file.heldout.empty()) json["heldout"] = detail::to_json(file.heldout);
  if (!file.test.empty()) json["test"] = detail::to_json(file.test);
  json["covariance"] = Json::array();
  for (const auto& row : file.covariance.rowwise()) {
    json["covariance"].push_back(std::vector<double>(row.begin(), row.end()));
  }
  return json.dump(1) + "\n";
}

/// Throws surefoot::MotionError that names `name` and the field.
inline MotionFile parse_motion_file(std::string_view text, const std::string& name) {
  // What is nested deeper than anything known is left out: the parser copies values, and deep ones overflow the stack.
  const auto known = [](int depth, detail::Json::parse_event_t, const detail::Json&) { return depth <= 16; };
  const detail::Json json = detail::Json::parse(text, known, false);
  if (json.is_discarded()) {
    throw surefoot::MotionError(name + ": this is not JSON; a file that surefoot-calibrate wrote is expected");
  }
  const detail::Fields root(json, name, "");
  if (root.text("schema") != "surefoot.motion/1") root.fail("schema", "only \"surefoot.motion/1\" is known");
  MotionFile file;
  const auto kind = model_named(root.text("model"));
  if (!kind) root.fail("model", "\"proportional\", \"simple\", \"full\" or \"previous-order\" is expected");
  file.kind = *kind;
  detail::parameters_from_json(root, file);
  const detail::Fields noise = root.object("noise");
  file.noise = detail::noise_from_json(noise);
  file.noise_shape_known = noise.flag("shape_known");
  const detail::Fields accuracy = root.object("measured_with");
  file.accuracy = {.position = accuracy.number("position_m", 0, 1e3),
                   .heading = accuracy.number("heading_rad", 0, 10),
                   .heading_tolerance = accuracy.number("heading_tolerance_rad", 0, 3.2)};
  file.steps_per_cycle = root.number("steps_per_cycle", 1e-6, 1e6);
  file.method = root.text("method");
  file.sequences = root.count("sequences");
  file.readings = root.count("readings");
  file.seed = root.count("seed");
  file.heldout = detail::evaluated_from_json(root, "heldout");
  file.test = detail::evaluated_from_json(root, "test");
  return file;
}

inline MotionFile read_motion_file(const std::filesystem::path& path) {
  const surefoot::Bytes bytes = surefoot::read_file(path);
  return parse_motion_file({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.filename().string());
}

/// Never leaves a file half written.
inline void write_motion_file(const std::filesystem::path& path, const MotionFile& file) {
  surefoot::write_file_atomically(path, motion_file_text(file));
}

}  // namespace calibrate_program

// Fields of a JSON object, with errors that name file and field.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "surefoot/core/error.hpp"

namespace calibrate_program::detail {

using Json = nlohmann::ordered_json;

/// Null if the object has no such member. No copy: the copy of a value that is nested deeply overflows the stack.
inline const Json& member(const Json& object, const char* name) {
  static const Json nothing;
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
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

}  // namespace calibrate_program::detail

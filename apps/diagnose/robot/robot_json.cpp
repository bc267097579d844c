#include <nlohmann/json.hpp>

#include "../json_number.hpp"
#include "../write_json.hpp"
#include "robot_files.hpp"

namespace diagnose_robot {
namespace {

using Json = nlohmann::ordered_json;

using diagnose_program::finite_or_null;

Json joints_json(const RobotDiagnosis& d) {
  Json list = Json::array();
  for (std::size_t j = 0; j < d.joints.size(); ++j) {
    const JointError& joint = d.joints[j];
    Json physics = Json::object(), shares = Json::object();
    for (const PropertyInfo& info : property_table()) {
      const double value = d.physics[j][info.property];
      if (value != 0) physics[info.effect][info.parameter] = value;
    }
    for (std::size_t c = 0; c < d.effect_columns.size(); ++c) {
      shares[d.effect_columns[c]] =
          finite_or_null(d.shares(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(c)));
    }
    list.push_back({{"joint", joint.joint},
                    {"group", joint.group},
                    {"unit", joint.unit},
                    {"rmse_textbook", finite_or_null(joint.textbook)},
                    {"rmse_nominal", finite_or_null(joint.nominal)},
                    {"rmse_after", finite_or_null(joint.after)},
                    {"rmse_heldout", finite_or_null(joint.held_out)},
                    {"noise", finite_or_null(joint.noise)},
                    {"physics", physics},
                    {"share_of_error", shares}});
  }
  return list;
}

Json differences_json(const RobotDiagnosis& d) {
  Json list = Json::array();
  for (const JointDifference& one : d.differences) {
    list.push_back({{"joint", one.joint},
                    {"group", one.group},
                    {"effect", one.effect},
                    {"parameter", one.parameter},
                    {"unit", one.unit},
                    {"difference", finite_or_null(one.difference)},
                    {"stderr", finite_or_null(one.standard_error)},
                    {"of_group", finite_or_null(one.of_group)},
                    {"differs", one.differs}});
  }
  return list;
}

Json not_named_json(const RobotDiagnosis& d) {
  Json list = Json::array();
  for (const SizeNotNamed& one : d.not_named) {
    list.push_back({{"place", one.place},
                    {"effect", one.effect},
                    {"parameter", one.parameter},
                    {"unit", one.unit},
                    {"value", finite_or_null(one.value)},
                    {"stderr", finite_or_null(one.standard_error)}});
  }
  return list;
}

Json invisible_json(const RobotDiagnosis& d) {
  Json list = Json::array();
  for (const InvisibleEffect& one : d.invisible)
    list.push_back({{"joint", one.joint}, {"effect", one.effect}, {"parameter", one.parameter}});
  return list;
}

Json augmented_json(const RobotDiagnosis& d) {
  Json list = Json::array();
  for (const AugmentedEntry& entry : d.augmented) {
    list.push_back({{"joint", entry.joint},
                    {"effect", entry.effect},
                    {"parameter", entry.parameter},
                    {"unit", entry.unit},
                    {"value", entry.value},
                    {"in_file", entry.in_file},
                    {"where", entry.where}});
  }
  return list;
}

}  // namespace

std::string robot_json(const RobotDiagnosis& d) {
  Json json = Json::parse(diagnose_program::diagnosis_json(d.common));
  json["robot"] = {{"drive", d.torque_driven ? "torque" : "position"},
                   {"error_unit", d.error_unit},
                   {"rmse_textbook", finite_or_null(d.textbook)},
                   {"rmse_nominal", finite_or_null(d.nominal)},
                   {"rmse_after", finite_or_null(d.after)},
                   {"rmse_heldout", finite_or_null(d.held_out)},
                   {"rmse_replayed", finite_or_null(d.replayed)},
                   {"step_s", d.step},
                   {"joints", joints_json(d)},
                   {"differences", differences_json(d)},
                   {"not_named", not_named_json(d)},
                   {"invisible", invisible_json(d)},
                   {"augmented", augmented_json(d)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace diagnose_robot

#include "setup_guess.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string_view>

#include "../names.hpp"
#include "../wording.hpp"
#include "surefoot/core/error.hpp"

namespace diagnose_robot {
namespace {

using diagnose_program::CsvColumn;

enum class Kind : unsigned char { angle, speed, goal, torque };

struct Match {
  std::size_t joint = 0;
  Kind kind = Kind::angle;
  bool found = false;
};

constexpr std::array<std::string_view, 12> goal_words{"goal", "target",    "command",  "cmd",   "des",  "desired",
                                                      "ref",  "reference", "setpoint", "order", "ctrl", "qd"};
constexpr std::array<std::string_view, 7> torque_words{"torque", "effort", "tau", "force", "load", "moment", "trq"};
constexpr std::array<std::string_view, 7> speed_words{"speed", "vel", "velocity", "dq", "qdot", "rate", "omega"};
constexpr std::array<std::string_view, 22> plain_words{
    "joint",    "rad",     "deg",    "n",     "m", "nm",     "s",     "q", "pos", "position", "angle",
    "measured", "present", "actual", "state", "j", "joints", "theta", "1", "mm",  "link",     "motor"};
constexpr std::array<std::string_view, 20> side_words{"l",  "r",  "left",  "right", "fl",   "fr",  "rl",
                                                      "rr", "bl", "br",    "lf",    "rf",   "lh",  "rh",
                                                      "hl", "hr", "front", "rear",  "back", "hind"};

template <std::size_t N>
bool is_in(const std::array<std::string_view, N>& words, const std::string& word) {
  return std::ranges::find(words, std::string_view(word)) != words.end();
}

// What tells a joint from others: its name parts that are no plain words; numbers stay.
std::vector<std::string> telling(const std::vector<std::string>& parts) {
  std::vector<std::string> result;
  for (const std::string& part : parts) {
    if (!is_in(plain_words, part) && !is_in(goal_words, part) && !is_in(torque_words, part) &&
        !is_in(speed_words, part))
      result.push_back(part);
  }
  return result;
}

// Letters and digits apart: arm1 as arm, 1; and q1 as q, 1.
std::vector<std::string> split_digits(const std::vector<std::string>& parts) {
  std::vector<std::string> result;
  for (const std::string& part : parts) {
    std::string now;
    for (const char c : part) {
      const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
      if (!now.empty() && digit != (std::isdigit(static_cast<unsigned char>(now.back())) != 0)) {
        result.push_back(now);
        now.clear();
      }
      now += c;
    }
    if (!now.empty()) result.push_back(now);
  }
  return result;
}

// Share of name parts that column and joint have in common; 1: all of both.
double likeness(const std::string& column, const std::string& joint) {
  std::vector<std::string> a = split_digits(name_parts(column)), b = split_digits(name_parts(joint));
  const std::vector<std::string> whole_b = b;
  const bool has_number = std::ranges::any_of(
      b, [](const std::string& part) { return std::isdigit(static_cast<unsigned char>(part[0])) != 0; });
  a = telling(a);
  b = telling(b);
  if (has_number && std::ranges::find(whole_b, "1") != whole_b.end()) b.push_back("1");
  for (const std::string& part : split_digits(name_parts(column))) {
    if (part == "1") a.push_back(part);
  }
  double common = 0;
  for (const std::string& part : b) common += std::ranges::find(a, part) != a.end() ? 1 : 0;
  const double all = static_cast<double>(a.size() + b.size()) - common;
  return all > 0 ? common / all : 0;
}

Kind kind_of(const std::string& column) {
  const std::vector<std::string> parts = name_parts(column), split = split_digits(parts);
  const auto any = [&](const auto& words) {
    return std::ranges::any_of(parts, [&](const std::string& p) { return is_in(words, p); }) ||
           std::ranges::any_of(split, [&](const std::string& p) { return is_in(words, p); });
  };
  if (any(goal_words)) return Kind::goal;
  if (any(torque_words) || column.ends_with("_N_m") || column.ends_with("_Nm") || column.ends_with("_N"))
    return Kind::torque;
  if (any(speed_words) || column.ends_with("rad_s") || column.ends_with("deg_s") || column.ends_with("_m_s"))
    return Kind::speed;
  return Kind::angle;
}

Match match(const RobotModel& model, const std::string& column) {
  Match best;
  double likest = 0.34;  // less than a third in common is chance
  bool twice = false;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const double like = likeness(column, model.joints[j].name);
    if (like > likest) {
      likest = like;
      best = {j, kind_of(column), true};
      twice = false;
    } else if (best.found && like == likest) {
      twice = true;
    }
  }
  if (twice) best.found = false;
  return best;
}

ColumnOf& column_of(JointSetup& joint, Kind kind) {
  return kind == Kind::angle   ? joint.angle
         : kind == Kind::speed ? joint.speed
         : kind == Kind::goal  ? joint.goal
                               : joint.torque;
}

// Degrees, where the name does not tell and the readings go beyond what radians could be.
bool looks_like_degrees(const CsvColumn& column, const ModelJoint& joint) {
  double reach = 0;
  for (const double value : column.values) {
    if (std::isfinite(value)) reach = std::max(reach, std::abs(value));
  }
  const double range = std::max({std::abs(joint.low), std::abs(joint.high), 2 * std::numbers::pi});
  return !joint.slides && reach > 2 * range;
}

void guess_time(const diagnose_program::Csv& csv, SetupGuess& guess) {
  for (const CsvColumn& column : csv.columns) {
    const std::vector<std::string> parts = name_parts(column.name);
    if (!parts.empty() && (parts[0] == "t" || parts[0] == "time" || parts[0] == "timestamp" || parts[0] == "stamp")) {
      guess.setup.time = column.name;
      return;
    }
  }
  throw surefoot::DiagnoseError(csv.file + ": no column looks like the time; name it t_s");
}

void guess_groups(const RobotModel& model, SetupGuess& guess) {
  std::map<std::string, std::vector<std::string>> members;
  std::vector<std::string> names;
  for (const JointSetup& joint : guess.setup.joints) {
    const auto found = std::ranges::find(model.joints, joint.name, &ModelJoint::name);
    std::string key = without_side(joint.name);
    if (key.empty()) key = found->class_name.empty() ? joint.name : found->class_name;
    if (std::ranges::find(names, key) == names.end()) names.push_back(key);
    members[key].push_back(joint.name);
  }
  for (const std::string& name : names) guess.setup.groups.push_back({name, members[name]});
}

void guess_drive(const diagnose_program::Csv& csv, SetupGuess& guess) {
  const auto has_torque = [](const JointSetup& joint) { return !joint.torque.name.empty(); };
  std::vector<std::string> without_goal;
  for (const JointSetup& joint : guess.setup.joints) {
    if (joint.goal.name.empty()) without_goal.push_back(joint.name);
  }
  if (without_goal.size() < guess.setup.joints.size() && !without_goal.empty() &&
      std::ranges::none_of(guess.setup.joints, has_torque)) {
    throw surefoot::DiagnoseError(csv.file + ": no column of a goal for " + diagnose_program::listed(without_goal) +
                                  "; add it, named like goal_" + without_goal.front() +
                                  "_rad, or leave out the angle of a joint that did not move");
  }
  const bool goals =
      std::ranges::all_of(guess.setup.joints, [](const JointSetup& joint) { return !joint.goal.name.empty(); });
  guess.setup.drive = goals ? DriveKind::position : DriveKind::torque;
  guess.remarks.push_back(goals ? "position drives, since every joint has a column of its goal"
                                : "torque drives, since not every joint has a column of its goal");
  if (!goals) {
    guess.setup.calibrate_gains = false;
    guess.remarks.push_back(
        "torques are taken as they are; write calibrate = [\"gains\"] if their scale is uncertain, with \"bodies\" if "
        "masses are");
    return;
  }
  double kp = 0, kd = 0;
  for (const auto& [key, text] : csv.meta) {
    const double number = diagnose_program::number_or_nan(text);
    if (key.starts_with("kp") && std::isfinite(number)) kp = number;
    if (key.starts_with("kd") && std::isfinite(number)) kd = number;
  }
  bool unknown = false;
  for (JointSetup& joint : guess.setup.joints) {
    if (joint.kp == 0) joint.kp = kp;
    if (joint.kd == 0) joint.kd = kd;
    unknown = unknown || joint.kp == 0;
  }
  guess.remarks.push_back(unknown
                              ? "SET kp and kd of the drives: neither the model nor the log states them"
                              : "kp and kd are those of the model's position actuators or of the log's first lines");
}

struct MatchedColumns {
  std::vector<JointSetup> joints;  // of the model, in its order
  std::vector<std::string> unused, degrees, not_radians;
};

MatchedColumns match_columns(const RobotModel& model, const diagnose_program::Csv& csv, const std::string& time) {
  MatchedColumns result;
  result.joints.resize(model.joints.size());
  std::vector<ColumnOf*> unitless;
  bool any_degrees = false;
  for (const CsvColumn& column : csv.columns) {
    if (column.name == time) continue;
    const Match matched = match(model, column.name);
    ColumnOf* target = matched.found ? &column_of(result.joints[matched.joint], matched.kind) : nullptr;
    if (target == nullptr || !target->name.empty()) {
      result.unused.push_back(column.name);
      continue;
    }
    target->name = column.name;
    const bool angle_like = matched.kind == Kind::angle || matched.kind == Kind::goal;
    const bool states_unit =
        column.name.find("deg") != std::string::npos || column.name.find("rad") != std::string::npos;
    if (!angle_like || model.joints[matched.joint].slides) continue;
    const bool beyond = looks_like_degrees(column, model.joints[matched.joint]);
    if (beyond && states_unit) {
      if (column.name.find("deg") == std::string::npos) result.not_radians.push_back(column.name);
    } else if (!states_unit) {
      unitless.push_back(target);
      any_degrees = any_degrees || beyond;
    }
  }
  // A log has one unit for its angles: what goes far beyond the range of one joint tells it for all.
  for (ColumnOf* column : unitless) {
    if (!any_degrees) break;
    column->factor = std::numbers::pi / 180;
    result.degrees.push_back(column->name);
  }
  return result;
}

}  // namespace

std::vector<std::string> name_parts(const std::string& name) {
  std::vector<std::string> parts;
  std::string now;
  char before = 0;
  for (const char c : name) {
    const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
    const bool begins =
        std::isupper(static_cast<unsigned char>(c)) != 0 && std::islower(static_cast<unsigned char>(before)) != 0;
    if ((!letter || begins) && !now.empty()) {
      parts.push_back(now);
      now.clear();
    }
    if (letter) now += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    before = c;
  }
  if (!now.empty()) parts.push_back(now);
  return parts;
}

std::string without_side(const std::string& joint) {
  std::string key;
  bool had_side = false;
  for (const std::string& part : name_parts(joint)) {
    if (is_in(side_words, part)) {
      had_side = true;
    } else if (part != "joint") {
      key += (key.empty() ? "" : "_") + part;
    }
  }
  return had_side ? key : joint;
}

SetupGuess guess_setup(const RobotModel& model, const diagnose_program::Csv& csv) {
  SetupGuess guess;
  guess.remarks.push_back("guessed from " + model.file + " and " + csv.file +
                          ": look through it before you rely on it");
  guess_time(csv, guess);
  MatchedColumns matched = match_columns(model, csv, guess.setup.time);
  std::vector<JointSetup>& joints = matched.joints;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const ModelJoint& joint = model.joints[j];
    joints[j].name = joint.name;
    if (joints[j].angle.name.empty()) {
      guess.setup.held.push_back(joint.name);
      continue;
    }
    joints[j].kp = joint.kp;
    joints[j].kd = joint.kd;
    joints[j].limit = joint.torque_limit;
    guess.setup.joints.push_back(joints[j]);
  }
  if (guess.setup.joints.empty()) {
    throw surefoot::DiagnoseError(csv.file + ": no column is named like a joint of " + model.file +
                                  "; rename the columns after the joints, for example " + model.joints.front().name +
                                  "_rad");
  }
  guess_drive(csv, guess);
  for (int j = 0; j < model.model->njnt; ++j) {
    const char* name = mj_id2name(model.model.get(), mjOBJ_JOINT, j);
    if (model.model->jnt_type[j] == mjJNT_BALL)
      guess.remarks.push_back("the ball joint " + std::string(name != nullptr ? name : "without a name") +
                              " cannot be diagnosed: only hinges and slides can");
  }
  const bool torque = guess.setup.drive == DriveKind::torque;
  std::erase_if(guess.setup.joints, [&](const JointSetup& joint) {
    if (!torque || !joint.torque.name.empty()) return false;
    guess.setup.held.push_back(joint.name);
    return true;
  });
  if (guess.setup.joints.empty()) {
    throw surefoot::DiagnoseError(csv.file +
                                  ": the joints have neither goals nor torques; add their columns, named like goal_" +
                                  model.joints.front().name + "_rad or torque_" + model.joints.front().name + "_N_m");
  }
  guess_groups(model, guess);
  guess.setup.base_held = model.floating_base;
  if (model.floating_base)
    guess.remarks.push_back("the model's base floats; base = \"held\" says that it was held in the recording");
  if (!guess.setup.held.empty())
    guess.remarks.push_back("joints without columns are listed under held: they must not have moved");
  if (!matched.unused.empty())
    guess.remarks.push_back("columns that belong to no joint and are not used: " +
                            diagnose_program::listed(matched.unused));
  guess.remarks.push_back(matched.degrees.empty()
                              ? "units are those that the names of columns end in, else rad, N m and s"
                              : "taken for degrees, since some go far beyond their joint's range: " +
                                    diagnose_program::listed(matched.degrees));
  if (!matched.not_radians.empty()) {
    guess.remarks.push_back("SET the unit, as in angle = { column = \"" + matched.not_radians.front() +
                            "\", unit = \"deg\" }: these are named radians but go far beyond their joint's range: " +
                            diagnose_program::listed(matched.not_radians));
  }
  return guess;
}

}  // namespace diagnose_robot

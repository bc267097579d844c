#include "mjcf.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <locale>
#include <sstream>
#include <string_view>

#include "../robot/walk_engine/joint_targets.hpp"

namespace sigmaban {
namespace {

using Vector = std::array<double, 3>;

std::string text(std::initializer_list<double> numbers) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(15);
  for (const double number : numbers) out << (out.tellp() > 0 ? " " : "") << number;
  return out.str();
}

std::string text(const Vector& v) { return text({v[0], v[1], v[2]}); }

/// name="numbers"
std::string attribute(std::string_view name, const std::string& value) {
  return " " + std::string(name) + "=\"" + value + "\"";
}

std::string attribute(std::string_view name, double value) { return attribute(name, text({value})); }

/// Mass of a solid box.
std::string inertia(const TwinLink& link) {
  const auto [a, b, c] = link.size;
  const double m = link.mass / 12;
  return "<inertial" + attribute("pos", text(link.centre)) + attribute("mass", link.mass) +
         attribute("diaginertia", text({m * (b * b + c * c), m * (a * a + c * c), m * (a * a + b * b)})) + "/>\n";
}

/// The same, with the box to look at.
std::string block(const TwinLink& link) {
  const auto [a, b, c] = link.size;
  return inertia(link) + "<geom type=\"box\"" + attribute("pos", text(link.centre)) +
         attribute("size", text({a / 2, b / 2, c / 2})) + "/>\n";
}

/// Chest, head and arms to look at: nothing touches them.
constexpr std::string_view upper_body_shape =
    "<geom type=\"box\" pos=\"0 0 0.11\" size=\"0.04 0.065 0.09\"/>\n"
    "<geom type=\"sphere\" pos=\"0.01 0 0.26\" size=\"0.055\"/>\n"
    "<geom type=\"capsule\" fromto=\"0 0.1 0.18 0 0.115 0.08\" size=\"0.022\"/>\n"
    "<geom type=\"capsule\" fromto=\"0 0.115 0.08 0.06 0.11 0\" size=\"0.02\"/>\n"
    "<geom type=\"capsule\" fromto=\"0 -0.1 0.18 0 -0.115 0.08\" size=\"0.022\"/>\n"
    "<geom type=\"capsule\" fromto=\"0 -0.115 0.08 0.06 -0.11 0\" size=\"0.02\"/>\n";

constexpr std::string_view surroundings =
    "<asset>\n<texture name=\"sky\" type=\"skybox\" builtin=\"flat\" rgb1=\"0.95 0.96 0.98\" width=\"8\" "
    "height=\"48\"/>\n<texture name=\"field\" type=\"2d\" builtin=\"checker\" rgb1=\"0.45 0.62 0.42\" "
    "rgb2=\"0.5 0.68 0.46\" width=\"100\" height=\"100\"/>\n<material name=\"field\" texture=\"field\" "
    "texuniform=\"true\" texrepeat=\"5 5\"/>\n</asset>\n";

constexpr std::string_view light =
    "<light pos=\"1 1 3\" dir=\"-0.3 -0.3 -1\" directional=\"true\" diffuse=\"0.7 0.7 0.7\"/>\n";

/// A servo, and the free play behind it.
std::string joint(const std::string& name, std::string_view axis, const TwinParameters& p,
                  const TwinSwitches& switches) {
  const std::string along = attribute("axis", std::string(axis));
  const auto place = static_cast<std::size_t>(std::ranges::find(joint_names, name) - joint_names.begin());
  const double friction = p.servo.dry_friction + (switches.at(place) ? switches.servo_friction : 0);
  std::string result =
      "<joint class=\"servo\"" + attribute("name", name) + along + attribute("frictionloss", friction) + "/>\n";
  if (switches.backlash > 0 && switches.at(place))
    result += "<joint class=\"play\"" + attribute("name", name + "_play") + along + "/>\n";
  return result;
}

std::string cleats(const std::string& side, double outwards, const TwinParameters& p) {
  const TwinCleats& c = p.cleats;
  std::string result;
  int number = 0;
  for (const double x : {c.x, -c.x}) {
    for (const double y : {c.y, -c.y}) {
      result += "<geom class=\"cleat\"" + attribute("name", side + "_cleat_" + std::to_string(++number)) +
                attribute("pos", text({x, y + outwards * c.outward, c.radius - p.leg.ankle_to_ground})) + "/>\n";
    }
  }
  return result;
}

/// `outwards` is 1 on the left and -1 on the right; `knee_to_ankle` is that of this leg [m].
std::string leg(const std::string& side, double outwards, double knee_to_ankle, const TwinParameters& p,
                const TwinSwitches& switches) {
  constexpr std::string_view x = "1 0 0", y = "0 1 0", z = "0 0 1";
  const auto body = [&](const std::string& name, const Vector& position, const std::string& joint_name,
                        std::string_view axis, const TwinLink& link) {
    return "<body" + attribute("name", side + "_" + name) + attribute("pos", text(position)) + ">\n" +
           joint(side + "_" + joint_name, axis, p, switches) + block(link);
  };
  return body("hip_yaw", {0, outwards * p.feet_distance / 2, 0}, "hip_yaw", z, p.hip_yaw) +
         body("hip_block", {0, 0, 0}, "hip_roll", x, p.hip_block) + body("thigh", {0, 0, 0}, "hip_pitch", y, p.thigh) +
         body("shin", {0, 0, -p.leg.hip_to_knee}, "knee", y, p.shin) +
         body("ankle_block", {0, 0, -knee_to_ankle}, "ankle_pitch", y, p.ankle_block) +
         body("foot", {0, 0, 0}, "ankle_roll", x, p.foot) + cleats(side, outwards, p) +
         "</body></body></body></body></body></body>\n";
}

std::string defaults(const TwinParameters& p, const TwinSwitches& switches) {
  const TwinServo& servo = p.servo;
  const double half_play = switches.backlash / 2;
  return "<default>\n<geom contype=\"0\" conaffinity=\"0\" rgba=\"0.75 0.77 0.8 1\"/>\n"
         "<default class=\"servo\"><joint type=\"hinge\"" +
         attribute("armature", servo.armature) + attribute("damping", servo.damping) +
         "/></default>\n"
         // The inertia of the gear wheels that are free; the stop is as stiff as the time step allows.
         "<default class=\"play\"><joint type=\"hinge\" armature=\"0.0003\" damping=\"0.01\" limited=\"true\"" +
         attribute("range", text({-half_play, half_play})) + attribute("solreflimit", text({4 * p.time_step, 1})) +
         "/></default>\n<default class=\"cleat\"><geom type=\"sphere\" contype=\"1\" condim=\"6\"" +
         attribute("size", p.cleats.radius) +
         attribute("friction", text({p.contact.friction, p.contact.torsional_friction, p.contact.rolling_friction})) +
         attribute("solref", text({p.contact.time_constant + switches.soft_ground, 1})) +
         " rgba=\"0.2 0.2 0.2 1\"/></default>\n</default>\n";
}

std::string actuators(const TwinParameters& p, const TwinSwitches& switches) {
  const double charge = 1 - switches.battery_drop / p.servo.voltage;
  const double stiffness = charge * p.servo.stiffness, limit = charge * p.servo.torque_limit;
  std::string result = "<actuator>\n";
  for (const std::string_view name : joint_names) {
    result += "<position" + attribute("name", std::string(name)) + attribute("joint", std::string(name)) +
              attribute("kp", stiffness) + " forcelimited=\"true\"" + attribute("forcerange", text({-limit, limit})) +
              "/>\n";
  }
  return result + "</actuator>\n";
}

}  // namespace

std::string mjcf(const TwinParameters& p, const TwinSwitches& switches) {
  const double ahead = std::sin(switches.slope_forward), left = std::sin(switches.slope_left);
  const Vector gravity{p.gravity * ahead, p.gravity * left, -p.gravity * std::sqrt(1 - ahead * ahead - left * left)};
  return "<mujoco model=\"twin\">\n<compiler angle=\"radian\"/>\n"
         "<option integrator=\"Euler\" cone=\"elliptic\" impratio=\"3\"" +
         attribute("timestep", p.time_step) + attribute("gravity", text(gravity)) + "/>\n" + defaults(p, switches) +
         // The larger friction of two geoms counts: the ground has none, the cleats decide.
         std::string(surroundings) + "<worldbody>\n" + std::string(light) +
         "<geom name=\"ground\" material=\"field\" type=\"plane\" size=\"0 0 1\" conaffinity=\"1\" friction=\"0 0 0\"" +
         attribute("solref", text({p.contact.time_constant + switches.soft_ground, 1})) +
         "/>\n<body name=\"trunk\">\n<freejoint name=\"trunk\"/>\n" + inertia(p.upper_body) +
         std::string(upper_body_shape) + leg("left", 1, p.leg.knee_to_ankle - switches.short_left_leg, p, switches) +
         leg("right", -1, p.leg.knee_to_ankle, p, switches) + "</body>\n</worldbody>\n" + actuators(p, switches) +
         "</mujoco>\n";
}

}  // namespace sigmaban

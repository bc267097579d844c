// Model and recording of a servo pendulum as text, for the tests of surefoot-diagnose.
#pragma once

#include <string>

namespace diagnose_test {

inline const std::string servo_model = R"TOML(schema = "surefoot.model/1"
name   = "servo pendulum"
kind   = "ode"
time   = "t_s"

[inputs]
goal = "goal_rad"

[let]
duty    = "min(max(kp*(goal - theta), -1), 1)"
tau     = "kt/R*(vin*duty - kt*omega)"
inertia = "armature + mass*length*length"

[states]
theta = { rate = "omega", initial = "column:theta_rad", unit = "rad" }
omega = { rate = "(tau - mass*g*length*sin(theta))/inertia", initial = "0", unit = "rad/s", effort = "inertia", effort_unit = "N m" }

[outputs]
theta_rad = { value = "theta", unit = "rad", noise = 0.001 }

[constants]
g = 9.81
mass = "meta:mass_kg"
length = "meta:length_m"
kp = "meta:kp"
vin = "meta:vin_V"

[parameters]
kt = { value = 1.6, min = 0.3, max = 5.0, unit = "N m/A" }
R = { value = 3.6, min = 0.5, max = 15.0, unit = "ohm" }
armature = { value = 0.012, min = 0.0005, max = 0.1, unit = "kg m^2" }
)TOML";

/// Forces on either velocity move both.
inline const std::string crane_model = R"TOML(schema = "surefoot.model/1"
name = "crane"
kind = "ode"
time = "t_s"
[inputs]
drive = "drive_N"
[let]
push = "drive + rub"
inertia = "M + m*sin(a)^2"
[states]
x = { rate = "v", initial = "column:x_m", unit = "m" }
v = { rate = "(push + m*sin(a)*(L*w^2 + g*cos(a)) - pivot*cos(a)/L)/inertia", initial = "0", unit = "m/s", force = "rub", effort_unit = "N" }
a = { rate = "w", initial = "column:a_rad", unit = "rad" }
w = { rate = "(-(push + m*L*w^2*sin(a))*cos(a) - (M + m)*g*sin(a) + pivot*(M + m)/(m*L))/(L*inertia)", initial = "0", unit = "rad/s", force = "pivot", effort_unit = "N m" }
[outputs]
x_m = { value = "x", unit = "m" }
a_rad = { value = "a", unit = "rad" }
[constants]
g = 9.81
L = 0.5
[parameters]
M = { value = 1.0, min = 0.5, max = 2.0, unit = "kg" }
m = { value = 0.5, min = 0.2, max = 1.0, unit = "kg" }
)TOML";

inline const std::string servo_csv =
    "# mass_kg: 0.5\n# length_m: 0.1\n# kp: 5\n# vin_V: 7.4\n# remark: test bench\n"
    "t_s,goal_rad,theta_rad\n"
    "0.000,0.0,0.01\n0.005,0.1,0.02\n0.010,0.2,\n0.015,0.3,0.05\n0.020,0.4,0.08\n0.025,0.5,nan\n0.030,0.5,0.15\n";

inline const std::string walk_model = R"TOML(schema = "surefoot.model/1"
name = "walk"
kind = "map"
sequence = "seq"
measured = "after step"
[inputs]
order = "order_m"
turn  = "turn_rad"
[let]
dx = "gain*order"
[states]
x = { next = "x + dx*cos(th)", initial = 0, unit = "m" }
y = { next = "y + dx*sin(th)", initial = 0, unit = "m" }
th = { next = "th + turn", initial = 0, unit = "rad" }
[outputs]
x_m = { value = "x", unit = "m" }
y_m = { value = "y", unit = "m" }
[parameters]
gain = { value = 1.0, min = 0.5, max = 2.0, unit = "1" }
[planar]
x = "x"
y = "y"
heading = "th"
forward = "dx"
turn = "turn"
)TOML";

/// `text` with the first `from` replaced; unchanged text is a mistake of the test and comes back empty.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) return {};
  return text.replace(at, from.size(), to);
}

}  // namespace diagnose_test

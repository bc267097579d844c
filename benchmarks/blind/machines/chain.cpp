// Chains of masses that slide or turn, with springs and dampers between them, under a force, a motor or a controller.
#include <algorithm>
#include <cmath>

#include "circle.hpp"
#include "grammar.hpp"

namespace machines {
namespace {

// Names of positions, speeds and commands, so that nothing can be told from a name.
struct Words {
  std::string position, speed, command;
};

struct Scales {
  std::size_t count = 1;
  bool turns = false, gravity = false, clamped = false;
  double time = 1, amplitude = 1, mass = 1, frequency = 1, force = 1;  // typical sizes of the whole
  std::string length_unit, speed_unit, force_unit, mass_unit;
};

Scales draw_scales(Random& random, const Grammar& grammar) {
  Scales s;
  s.count = grammar.draw_own(random) ? 3 : 1 + random.index(2);
  s.turns = random.chance(0.5);
  s.gravity = s.turns && random.chance(0.4);
  s.clamped = !s.gravity && random.chance(0.5);
  s.time = random.log_uniform(0.12, 3);
  s.amplitude = s.turns ? random.uniform(0.3, 1.6) : random.log_uniform(2e-3, 1);
  s.mass = s.turns ? random.log_uniform(1e-4, 50) : random.log_uniform(0.02, 3000);
  s.frequency = circle / s.time;
  s.force = s.mass * s.frequency * s.frequency * s.amplitude;
  s.length_unit = s.turns ? "rad" : "m";
  s.speed_unit = s.turns ? "rad/s" : "m/s";
  s.force_unit = s.turns ? "N m" : "N";
  s.mass_unit = s.turns ? "kg m^2" : "kg";
  return s;
}

std::string index(std::size_t i) { return std::to_string(i + 1); }

class Chain {
 public:
  Chain(Random& random, const Grammar& grammar) : random_(random), grammar_(grammar), s_(draw_scales(random, grammar)) {
    const std::vector<Words> turning{{"theta", "omega", "goal"}, {"q", "qd", "target"}, {"phi", "rate", "ref"}};
    const std::vector<Words> sliding{{"x", "v", "goal"}, {"pos", "vel", "setpoint"}, {"p", "s", "ref"}};
    words_ = random.choice(s_.turns ? turning : sliding);
    machine_.family = "chain";
    machine_.time_scale = s_.time;
    machine_.period = std::clamp(s_.time / random.uniform(25, 60) / (s_.count > 1 ? 1.6 : 1), 0.002, 0.1);
    machine_.period = three_digits(machine_.period);
  }

  Draft draw() {
    draw_bodies();
    draw_actuator();
    finish_rates();
    draw_outputs();
    machine_.title = std::to_string(s_.count) + (s_.turns ? " turning" : " sliding") + title_;
    draft_.duration = s_.time * random_.uniform(8, 20);
    if (draft_.initial_range.empty() && random_.chance(0.3) && !open_loop_free()) {
      draft_.initial_range.assign(2 * s_.count, 0.0);
      for (std::size_t i = 0; i < s_.count; ++i) draft_.initial_range[2 * i] = 0.4 * s_.amplitude;
      machine_.at_rest = false;
    }
    draft_.machine = machine_;
    return draft_;
  }

 private:
  std::string position(std::size_t i) const { return words_.position + index(i); }
  std::string speed(std::size_t i) const { return words_.speed + index(i); }
  bool open_loop_free() const { return !s_.clamped && !s_.gravity && !controlled_; }

  void parameter(const std::string& name, const std::string& unit, double actual, double known = 0.15) {
    machine_.parameters.push_back(guess(random_, name, unit, actual, random_.chance(known)));
  }

  void draw_bodies() {
    force_.assign(s_.count, "");
    for (std::size_t i = 0; i < s_.count; ++i) {
      const double share = s_.count == 1 ? 1 : random_.uniform(0.3, 0.7) * 2 / static_cast<double>(s_.count);
      parameter((s_.turns ? "J" : "m") + index(i), s_.mass_unit, s_.mass * share, 0.3);
      if (i > 0) link(i - 1, i, index(i - 1));
    }
    if (s_.count == 3 && random_.chance(0.5)) link(0, 2, "b");
    if (s_.clamped) {
      const std::size_t where = grammar_.draw_own(random_) ? s_.count - 1 : 0;
      parameter("k0", s_.force_unit + "/" + s_.length_unit,
                s_.mass * std::pow(s_.frequency, 2) * random_.uniform(0.5, 1.5));
      force_[where] += " - k0*" + position(where);
    }
    if (s_.gravity) {
      const std::size_t last = s_.count - 1;
      parameter("weight", "N m", s_.mass * std::pow(s_.frequency, 2) * random_.uniform(0.4, 1.2));
      machine_.signals.push_back({"hang", "-weight*sin(" + position(last) + ")", "N m"});
      force_[last] += " + hang";
    }
    if (s_.clamped || random_.chance(0.6)) damper();
  }

  void damper() {
    has_damper_ = true;
    parameter("c0", s_.force_unit + " s/" + s_.length_unit, 2 * random_.uniform(0.05, 0.4) * s_.mass * s_.frequency);
    force_[0] += " - c0*" + speed(0);
  }

  void link(std::size_t from, std::size_t to, const std::string& name) {
    const double stiffness = s_.mass * std::pow(s_.frequency * random_.uniform(1.2, 2.2), 2) * 0.5;
    const std::string per = s_.force_unit + "/" + s_.length_unit;
    parameter("k" + name, per, stiffness, 0.1);
    parameter("d" + name, s_.force_unit + " s/" + s_.length_unit,
              2 * random_.uniform(0.03, 0.2) * std::sqrt(stiffness * s_.mass), 0.1);
    machine_.signals.push_back({"bend" + name, position(from) + " - " + position(to), s_.length_unit, false});
    machine_.signals.push_back(
        {"pass" + name, "k" + name + "*bend" + name + " + d" + name + "*(" + speed(from) + " - " + speed(to) + ")",
         s_.force_unit, false});
    machine_.links.push_back({"bend" + name, static_cast<int>(2 * from + 1), static_cast<int>(2 * to + 1)});
    force_[from] += " - pass" + name;
    force_[to] += " + pass" + name;
  }

  void draw_actuator() {
    const std::size_t kind = random_.index(4);
    motor_ = kind == 1 || kind == 2;
    current_ = kind == 2 || (kind == 3 && random_.chance(0.2));
    controlled_ = kind == 3 || (kind == 1 && random_.chance(0.4));
    if (kind == 3) motor_ = random_.chance(0.5);
    current_ = current_ && motor_;
    if (!motor_ && !has_damper_ && !s_.gravity) damper();
    if (controlled_) {
      draw_controller();
    } else if (motor_) {
      machine_.inputs.push_back({"voltage", "motor_V", "V", 1});
      volts_ = "voltage";
      supply_ = random_.choice(Values{6, 12, 24, 48});
      draft_.middle.push_back(0), draft_.swing.push_back(supply_);
    } else {
      machine_.inputs.push_back({"push", s_.turns ? "push_Nm" : "push_N", s_.force_unit, 1});
      draft_.middle.push_back(0), draft_.swing.push_back(s_.force * random_.uniform(0.5, 1.5));
      drive_ = "push";
    }
    if (motor_) draw_motor();
    force_[0] = drive_ + force_[0];
  }

  void draw_motor() {
    const double stall = s_.force * random_.uniform(1, 3);
    const double damping = 2 * random_.uniform(0.15, 0.7) * s_.mass * s_.frequency;  // kt^2/R
    const double constant = damping * supply_ / stall, resistance = constant * constant / damping;
    parameter("kt", s_.force_unit + "/A", constant, 0.3);
    parameter("R", "ohm", resistance, 0.3);
    if (!current_) {
      machine_.signals.push_back({"effort", "kt/R*(" + volts_ + " - kt*" + speed(0) + ")", s_.force_unit, true});
    } else {
      parameter("L", "H", resistance * machine_.period * random_.uniform(2, 8), 0.3);
      machine_.signals.push_back({"effort", "kt*current", s_.force_unit, false});
    }
    drive_ = "effort";
    title_ += current_ ? ", motor with inductance" : ", motor";
  }

  void draw_controller() {
    const std::size_t side = s_.count > 1 && random_.chance(0.3) ? s_.count - 1 : 0;
    const bool own = grammar_.draw_own(random_);
    const std::string error = "(" + words_.command + " - " + position(side) + ")";
    const double soft = side > 0 ? 0.35 : 1;
    const double top = s_.force * random_.uniform(1, 3);
    const double kp = soft * random_.uniform(0.6, 1.6) * s_.mass * std::pow(s_.frequency, 2) / top;
    machine_.inputs.push_back({words_.command, words_.command + (s_.turns ? "_rad" : "_m"), s_.length_unit, 0});
    draft_.middle.push_back(0), draft_.swing.push_back(s_.amplitude);
    std::string duty = "gain*" + error;
    const double spread = random_.chance(0.4) ? 2 : 1;
    if (own && random_.chance(0.5)) {
      duty = switching(error);
      title_ += ", on/off control";
    } else {
      machine_.constants.push_back({"gain", 0, "gain"});
      draft_.metas.push_back({"gain", {three_digits(kp), three_digits(kp / spread)}});
      if (own) integral(kp, error, duty);
      if (random_.chance(0.5)) {
        machine_.constants.push_back({"kd", three_digits(kp * 2 * random_.uniform(0.1, 0.4) / s_.frequency)});
        duty += " - kd*" + speed(side);
      }
      if (random_.chance(0.6)) duty = "min(max(" + duty + ", -1), 1)";
    }
    title_ += ", position control" + std::string(side > 0 ? " of the load" : "");
    machine_.signals.push_back({"duty", duty, "1", true, 2});
    if (motor_) {
      supply_ = random_.choice(Values{6, 12, 24, 48});
      machine_.constants.push_back({"supply", supply_});
      machine_.signals.push_back({"volts", "supply*duty", "V", true, 2});
      volts_ = "volts";
    } else {
      parameter("top", s_.force_unit, top, 0.2);
      machine_.signals.push_back({"effort", "top*duty", s_.force_unit, true, 2});
      drive_ = "effort";
    }
  }

  std::string switching(const std::string& error) {
    machine_.constants.push_back({"band", three_digits(0.1 * s_.amplitude)});
    machine_.constants.push_back({"edge", three_digits(0.03 * s_.amplitude)});
    return "0.5*(tanh((" + error + " - band)/edge) + tanh((" + error + " + band)/edge))";
  }

  void integral(double kp, const std::string& error, std::string& duty) {
    machine_.constants.push_back({"ki", three_digits(kp * s_.frequency * random_.uniform(0.02, 0.1))});
    integral_ = error;
    duty += " + ki*sum";
    title_ += ", integral";
  }

  void finish_rates() {
    for (std::size_t i = 0; i < s_.count; ++i) {
      const std::string body = (s_.turns ? "J" : "m") + index(i);
      State place{position(i), speed(i), s_.length_unit};
      State motion{speed(i), "(" + force_[i] + ")/" + body, s_.speed_unit};
      if (force_[i].rfind(" + ", 0) == 0) motion.rate = "(" + force_[i].substr(3) + ")/" + body;
      if (force_[i].rfind(" - ", 0) == 0) motion.rate = "(-" + force_[i].substr(3) + ")/" + body;
      if (random_.chance(0.8)) motion.effort = body, motion.effort_unit = s_.force_unit;
      motion.position = static_cast<int>(2 * i);
      motion.is_speed = true;
      if (i == 0) motion.drive = drive_;
      if (s_.gravity && i + 1 == s_.count) motion.load = "hang";
      machine_.states.push_back(place);
      machine_.states.push_back(motion);
    }
    if (current_) machine_.states.push_back({"current", "(" + volts_ + " - R*current - kt*" + speed(0) + ")/L", "A"});
    if (!integral_.empty()) machine_.states.push_back({"sum", integral_, s_.length_unit + " s"});
  }

  void output(std::size_t i, bool of_speed) {
    const std::string name = of_speed ? speed(i) : position(i);
    const std::string unit = of_speed ? (s_.turns ? "_rad_s" : "_m_s") : (s_.turns ? "_rad" : "_m");
    machine_.outputs.push_back(
        {name + unit, name, of_speed ? s_.speed_unit : s_.length_unit, static_cast<int>(2 * i + (of_speed ? 1 : 0))});
  }

  void draw_outputs() {
    const std::size_t last = s_.count - 1, which = s_.count == 1 ? 0 : random_.index(3);
    std::string measured;
    for (const std::size_t i : {std::size_t{0}, last}) {
      if ((i == 0 && which == 1) || (i == last && which == 0 && last > 0)) continue;
      output(i, false);
      measured = machine_.outputs.back().column;
      if (random_.chance(0.25)) output(i, true);
      if (last == 0) break;
    }
    for (std::size_t i = 0; i < s_.count; ++i) {
      const std::string own = position(i) + (s_.turns ? "_rad" : "_m");
      const bool seen = std::ranges::any_of(machine_.outputs, [&](const Output& one) { return one.column == own; });
      machine_.states[2 * i].initial = "column:" + (seen ? own : measured);
    }
  }

  Random& random_;
  const Grammar& grammar_;
  Scales s_;
  Words words_;
  Machine machine_;
  Draft draft_;
  std::vector<std::string> force_;  // on each body
  std::string drive_, volts_, integral_, title_;
  double supply_ = 12;
  bool motor_ = false, current_ = false, controlled_ = false, has_damper_ = false;
};

}  // namespace

Draft draw_chain(Random& random, const Grammar& grammar) { return Chain(random, grammar).draw(); }

}  // namespace machines

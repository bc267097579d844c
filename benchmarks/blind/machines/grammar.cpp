#include "grammar.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "../plants/systems.hpp"
#include "../plants/text.hpp"

namespace machines {

using plants::text;

const std::vector<std::string>& families() {
  static const std::vector<std::string> all{"chain", "chain", "drive", "tanks", "heater", "chain", "lift", "rover"};
  return all;
}

Draft draw_machine(Random& random, const Grammar& grammar, const std::string& family) {
  if (family == "chain") return draw_chain(random, grammar);
  if (family == "drive") return draw_drive(random, grammar);
  if (family == "tanks") return draw_tanks(random, grammar);
  if (family == "heater") return draw_heater(random, grammar);
  if (family == "lift") return draw_lift(random, grammar);
  if (family == "rover") return draw_rover(random, grammar);
  throw std::invalid_argument("unknown family " + family);
}

double three_digits(double value) { return std::stod(text(value, "%.3g")); }

plants::Parameter guess(Random& random, const std::string& name, const std::string& unit, double actual, bool fixed) {
  const double wrong = fixed ? 1.0 : random.uniform(0.7, 1.3);
  const double nominal = std::stod(text(actual * wrong, "%.4g"));
  const double below = random.log_uniform(5, 100), above = random.log_uniform(5, 100);
  return {name, unit, fixed ? nominal : actual, nominal, three_digits(nominal / below), three_digits(nominal * above),
          fixed};
}

std::string model_toml(const Machine& machine, const std::vector<double>& noise, bool with_noise) {
  const auto quoted = [](const std::string& value) { return "\"" + value + "\""; };
  std::string toml = "schema = \"surefoot.model/1\"\nname = " + quoted(machine.title) +
                     "\nkind = \"ode\"\ntime = \"t_s\"\n\n[inputs]\n";
  for (const Input& one : machine.inputs)
    toml += one.name + " = { column = " + quoted(one.column) + ", unit = " + quoted(one.unit) + " }\n";
  if (!machine.signals.empty()) toml += "\n[let]\n";
  for (const Signal& one : machine.signals) toml += one.name + " = " + quoted(one.formula) + "\n";
  toml += "\n[states]\n";
  for (const State& one : machine.states) {
    toml += one.name + " = { rate = " + quoted(one.rate) + ", initial = " + quoted(one.initial);
    toml += ", unit = " + quoted(one.unit);
    if (!one.effort.empty()) toml += ", effort = " + quoted(one.effort) + ", effort_unit = " + quoted(one.effort_unit);
    toml += " }\n";
  }
  toml += "\n[outputs]\n";
  for (std::size_t k = 0; k < machine.outputs.size(); ++k) {
    const Output& one = machine.outputs[k];
    toml += one.column + " = { value = " + quoted(one.formula) + ", unit = " + quoted(one.unit) +
            plants::noise_entry(with_noise, noise[k]) + " }\n";
  }
  if (!machine.constants.empty()) toml += "\n[constants]\n";
  for (const Constant& one : machine.constants)
    toml += one.name + " = " + (one.meta.empty() ? text(one.value) : quoted("meta:" + one.meta)) + "\n";
  toml += "\n[parameters]\n";
  for (const plants::Parameter& p : machine.parameters) {
    toml += p.name + " = { value = " + text(p.nominal) + ", min = " + text(p.low) + ", max = " + text(p.high);
    toml += ", unit = " + quoted(p.unit) + (p.fixed ? ", fixed = true" : "") + " }\n";
  }
  return toml;
}

}  // namespace machines

#include "diagnose_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

namespace calibrate_program {
namespace {

std::string shown(double value) { return nlohmann::json(value).dump(); }

std::string quoted(const std::string& text) {  // a basic string of TOML
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

/// "dx per last dy" as a name in equations.
std::string symbol(std::string_view name) {
  std::string result(name);
  std::ranges::replace(result, ' ', '_');
  return result;
}

std::string times(const std::string& what, double factor) { return factor == 1 ? what : shown(factor) + "*" + what; }

std::vector<std::string> symbols(const surefoot::AnyMotionModel& model) {
  std::vector<std::string> result;
  for (const surefoot::ModelParameter& info : model.parameter_info()) result.push_back(symbol(info.name));
  return result;
}

/// "dx_offset + dx_per_dx*ox + ...", of the coefficients that the model has; `offset` is what an offset is divided by.
std::string row(const std::string& output, const std::vector<std::string>& known, bool wheels) {
  const auto has = [&](const std::string& name) { return std::ranges::find(known, name) != known.end(); };
  std::string sum;
  const auto add = [&](const std::string& name, const std::string& factor) {
    if (has(name)) sum += (sum.empty() ? "" : " + ") + name + factor;
  };
  add(output + "_offset", wheels ? "/period" : "");
  for (const char* command : {"dx", "dy", "dt"}) {
    if (wheels && command[1] == 'y') continue;  // they cannot be told to go sideways
    const std::string o = "o" + std::string(command).substr(1);
    add(output + "_per_" + command, "*" + o);
    add(output + "_per_last_" + command, wheels ? "*" + o : "*last_" + o);
  }
  return sum.empty() ? "0" : sum;
}

void write_parameters(std::ostream& out, const MotionFile& file, const std::vector<bool>& determined, bool wheels) {
  out << "\n[parameters]\n";
  Eigen::Index i = 0;
  for (const surefoot::ModelParameter& info : default_model(file.kind).parameter_info()) {
    const bool used = !wheels || info.name.substr(2).find("dy") == std::string_view::npos;
    if (used)
      out << symbol(info.name) << " = { value = " << shown(file.parameters[i]) << ", min = " << shown(info.low)
          << ", max = " << shown(info.high) << ", unit = \"" << info.unit << "\""
          << (determined[static_cast<std::size_t>(i)] ? "" : ", fixed = true") << " }\n";
    ++i;
  }
}

struct PoseState {
  const char* name;
  const char* unit;
  Column column;
  bool measured;
};

std::array<PoseState, 3> pose_states(const FileLayout& layout) {
  const auto& pose = layout.columns.pose;
  return {{{"x", "m", *pose[0], true},
           {"y", "m", *pose[1], true},
           {"th", "rad", pose[2].value_or(Column{}), pose[2].has_value()}}};
}

/// States in the units of their columns, so that they may start as measured.
void write_states(std::ostream& out, const FileLayout& layout, const std::array<std::string, 3>& steps,
                  const std::string& verb, const std::string& more, const surefoot::Vec<3>& process_noise) {
  const auto states = pose_states(layout);
  out << "\n[states]\n";
  for (std::size_t i = 0; i < 3; ++i) {
    const PoseState& state = states[i];
    const std::string step = state.column.factor == 1 ? steps[i] : "(" + steps[i] + ")/" + shown(state.column.factor);
    out << state.name << " = { " << verb << " = "
        << quoted((verb == "next" ? std::string(state.name) + " + " : std::string()) + step)
        << ", initial = " << (layout.measured_start && state.measured ? quoted("column:" + state.column.name) : "0")
        << ", unit = \"" << (state.column.factor == 1 ? state.unit : "1") << "\" }\n";
  }
  out << more << "\n[outputs]\n";
  for (std::size_t i = 0; i < 3; ++i) {
    const PoseState& state = states[i];
    if (!state.measured) continue;
    out << quoted(state.column.name) << " = { value = \"" << state.name << "\", unit = \""
        << (state.column.factor == 1 ? state.unit : "1") << "\"";
    if (process_noise[static_cast<int>(i)] > 0)
      out << ", process_noise = " << shown(process_noise[static_cast<int>(i)] / state.column.factor);
    out << " }\n";
  }
}

std::string heading(const FileLayout& layout) { return times("th", pose_states(layout)[2].column.factor); }

/// Standard deviation by which a cycle, predicted from the pose before, is off in x, y and heading, over these
/// commands: the noise of the walk, turned as the robot was, and that of the readings before and after.
surefoot::Vec<3> cycle_noise(const MotionFile& file, std::span<const surefoot::WalkSequence> sequences) {
  surefoot::Vec<3> squares = surefoot::Vec<3>::Zero();
  double cycles = 0;
  for (const surefoot::WalkSequence& sequence : sequences) {
    for (Eigen::Index i = 0; i < sequence.cycles(); ++i, ++cycles) {
      const surefoot::Vec<3> own =
          file.noise.deviation(sequence.commands.col(i), sequence.previous_command(i)).cwiseAbs2();
      double along = i == 0 ? 1 : std::pow(std::cos(sequence.poses(2, i - 1)), 2);
      if (!std::isfinite(along)) along = 0.5;  // an unknown heading
      squares += surefoot::Vec<3>(along * own[0] + (1 - along) * own[1], (1 - along) * own[0] + along * own[1], own[2]);
    }
  }
  return (squares / std::max(cycles, 1.0) + 2 * file.accuracy.variance()).cwiseSqrt();
}

void write_walk(std::ostream& out, const std::vector<std::string>& known, bool previous, const FileLayout& layout,
                const surefoot::Vec<3>& process_noise) {
  constexpr std::array<const char*, 3> inputs{"order_forward", "order_lateral", "order_turn"},
      commands{"ox", "oy", "ot"};
  out << "kind   = \"map\"\n";
  if (layout.many)
    out << "sequence = \"seq\"\nmeasured = \"after step\"  # the pose of a row is that at its cycle's end\n";
  out << "\n[inputs]\n";
  for (std::size_t i = 0; i < 3; ++i) out << inputs[i] << " = " << quoted(layout.columns.commands[i].name) << "\n";
  out << "\n[let]  # the command of a cycle [m, m, rad], and what comes of it\n";
  for (std::size_t i = 0; i < 3; ++i) {
    out << commands[i] << " = " << quoted(times(inputs[i], layout.steps_per_cycle * layout.columns.commands[i].factor))
        << "\n";
  }
  for (const char* moved : {"dx", "dy", "dt"}) out << moved << " = " << quoted(row(moved, known, false)) << "\n";
  out << "facing = " << quoted(heading(layout)) << "\n";
  std::string last;
  for (std::size_t i = 0; i < 3 && previous; ++i) {
    last += "last_" + std::string(commands[i]) + " = { next = \"" + commands[i] + "\", initial = 0, unit = \"" +
            (i < 2 ? "m" : "rad") + "\" }\n";
  }
  write_states(out, layout, {"dx*cos(facing) - dy*sin(facing)", "dx*sin(facing) + dy*cos(facing)", "dt"}, "next", last,
               process_noise);
}

void write_planar(std::ostream& out, const FileLayout& layout) {
  for (const PoseState& state : pose_states(layout)) {
    if (state.column.factor != 1) return;  // the walking effects count in metres and radians
  }
  out << "\n[planar]\nx       = \"x\"\ny       = \"y\"\nheading = \"th\"\nforward = \"dx\"\nlateral = \"dy\"\n"
         "turn    = \"dt\"\n";
}

void write_wheels(std::ostream& out, const std::vector<std::string>& known, const FileLayout& layout,
                  const LoadOptions& options) {
  const auto& columns = layout.columns.commands;
  out << "kind   = \"ode\"\ntime   = \"t_s\"\n\n[inputs]\nleft  = " << quoted(columns[0].name)
      << "\nright = " << quoted(columns[1].name) << "\n\n[let]  # speeds as commanded, and what comes of them\n"
      << "ox = " << quoted(times("(left + right)/2", columns[0].factor))
      << "\not = " << quoted(times("(right - left)/base", columns[0].factor)) << "\n";
  constexpr std::array<const char*, 3> names{"forward", "lateral", "turning"}, rows{"dx", "dy", "dt"};
  for (std::size_t i = 0; i < 3; ++i) out << names[i] << " = " << quoted(row(rows[i], known, true)) << "\n";
  out << "facing = " << quoted(heading(layout)) << "\n";
  write_states(out, layout,
               {"forward*cos(facing) - lateral*sin(facing)", "forward*sin(facing) + lateral*cos(facing)", "turning"},
               "rate", "", surefoot::Vec<3>::Zero());
  out << "\n[constants]\nbase   = " << shown(options.wheel_base) << "  # [m]\nperiod = " << shown(layout.period)
      << "  # mean time of a row [s]\n";
}

}  // namespace

std::string diagnose_model(const MotionFile& file, const std::vector<bool>& determined, const FileLayout& layout,
                           const LoadOptions& options, std::span<const surefoot::WalkSequence> sequences) {
  const bool wheels = !options.columns.wheels.empty();
  std::ostringstream out;
  out << "# As calibrated from " << file.sequences << " sequences (" << name_of(file.kind) << ", " << file.method
      << ").\nschema = \"surefoot.model/1\"\nname   = \"calibrated motion\"\n";
  const std::vector<std::string> known = symbols(default_model(file.kind));
  if (wheels) {
    write_wheels(out, known, layout, options);
  } else {
    write_walk(out, known, file.kind == ModelKind::previous_command, layout, cycle_noise(file, sequences));
  }
  write_parameters(out, file, determined, wheels);
  if (!wheels) write_planar(out, layout);
  return out.str();
}

}  // namespace calibrate_program

// A walking robot that executes orders cycle by cycle: the displacement of a cycle is linear in the order, with 3, 6 or
// 12 coefficients; every cycle adds process noise. The pose is measured in every row or by tape in the last one only.
#include "excitation.hpp"
#include "signal_faults.hpp"
#include "systems.hpp"
#include "walk_faults.hpp"

namespace plants {
namespace {

// Displacement ordered by the nominal model. p: per axis the own gain; or offset, own gain; or offset and three gains.
Triple linear_step(const Values& p, const Triple& order) {
  Triple step{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (p.size() == 3) step[axis] = p[axis] * order[axis];
    if (p.size() == 6) step[axis] = p[2 * axis] + p[2 * axis + 1] * order[axis];
    if (p.size() != 12) continue;
    step[axis] = p[4 * axis];
    for (std::size_t k = 0; k < 3; ++k) step[axis] += p[4 * axis + 1 + k] * order[k];
  }
  return step;
}

void change_in_body(const Fault& fault, std::size_t row, const Triple& order, const Triple& pose, Triple& step) {
  const auto axis = static_cast<std::size_t>(fault.target);
  switch (fault.formula) {
    case Formula::slip:
      step[axis] = fault.a * std::tanh(step[axis] / fault.a);
      return;
    case Formula::slip_hard:
      step[axis] = soft_clip(step[axis], fault.a);
      return;
    case Formula::body_drift:
      step[0] += fault.a, step[1] += fault.b, step[2] += fault.c;
      return;
    case Formula::coupling:
      step[axis] += fault.a * step[static_cast<std::size_t>(fault.b)];
      return;
    case Formula::stumble:
      if (std::abs(order[0]) / top_order[0] + std::abs(order[2]) / top_order[2] > fault.b) step[2] += fault.a;
      return;
    case Formula::patch: {
      const double x = pose[0] - fault.b, y = pose[1] - fault.c;
      if (x * x + y * y < 0.15 * 0.15) step[0] *= 1 - fault.a, step[2] *= 1 - fault.a;
      return;
    }
    case Formula::odd_steps:
      if (row % 3 == 1) step[2] += fault.a, step[0] *= 1 - fault.b;
      return;
    case Formula::turn_kick:
      step[2] += fault.a * std::sin(2 * pose[2] + fault.b);
      return;
    default:
      return;
  }
}

Triple moved(const Triple& pose, const Triple& step) {
  const double c = std::cos(pose[2]), s = std::sin(pose[2]);
  return {pose[0] + step[0] * c - step[1] * s, pose[1] + step[0] * s + step[1] * c, pose[2] + step[2]};
}

Series simulate(const Values& parameters, const std::vector<Fault>& faults, const Recording& recording, const How& how,
                const Values& process_noise) {
  std::vector<Column> orders = recording.inputs;
  Column rows(orders[0].size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<double>(i);
  for (const Fault& fault : faults)
    if (fault.place == Place::input) change_order(fault, rows, orders[static_cast<std::size_t>(fault.target)]);

  Triple pose{recording.initial[0], recording.initial[1], recording.initial[2]};
  Series series{std::vector<Column>(3), {}};
  for (std::size_t row = 0;; ++row) {
    for (std::size_t k = 0; k < 3; ++k) series.states[k].push_back(pose[k]);
    if (row + 1 >= rows.size()) break;
    if (how.stepwise &&
        std::isfinite(recording.readings[0][row] + recording.readings[1][row] + recording.readings[2][row])) {
      for (std::size_t k = 0; k < 3; ++k) pose[k] = recording.readings[k][row];
    }
    const Triple order{orders[0][row], orders[1][row], orders[2][row]};
    Values p = parameters;
    for (const Fault& fault : faults)
      if (fault.place == Place::parameter)
        p[static_cast<std::size_t>(fault.target)] *= factor_of_parameter(fault, rows[row]);
    Triple step = linear_step(p, order);
    const Triple planned = step;
    for (const Fault& fault : faults) change_in_body(fault, row, order, pose, step);
    if (how.noise != nullptr) {
      for (std::size_t k = 0; k < 3; ++k) step[k] += how.noise->normal(process_noise[k]);
    }
    pose = moved(pose, step);
    for (const Fault& fault : faults) {
      const double distance = std::hypot(planned[0], planned[1]);
      const double share = fault.formula == Formula::slope            ? 1
                           : fault.formula == Formula::slope_distance ? distance
                                                                      : 0;
      pose[0] += share * fault.a;
      pose[1] += share * fault.b;
    }
  }
  series.outputs = series.states;
  for (const Fault& fault : faults)
    if (fault.place == Place::sensor)
      change_readings(fault, rows, series.outputs[static_cast<std::size_t>(fault.target)]);
  return series;
}

std::string walk_toml(const System& system, bool with_noise) {
  std::string toml =
      "schema = \"surefoot.model/1\"\nname   = \"" + system.model_name + "\"\nkind   = \"map\"\n\n[inputs]\n";
  for (std::size_t k = 0; k < 3; ++k) toml += order_names[k] + " = \"" + order_columns[k] + "\"\n";
  toml += "\n[let]\n";
  const std::size_t per_axis = system.parameters.size() / 3;
  const std::vector<std::string> steps{"dx", "dy", "dt"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    toml += steps[axis] + " = \"";
    for (std::size_t k = 0; k < per_axis; ++k) {
      const std::string& name = system.parameters[axis * per_axis + k].name;
      const bool offset = per_axis > 1 && k == 0;
      const std::size_t order = per_axis == 4 ? k - 1 : axis;
      toml += (k > 0 ? " + " : "") + name + (offset ? "" : "*" + order_names[order]);
    }
    toml += "\"\n";
  }
  toml += R"toml(
[states]
x  = { next = "x + dx*cos(th) - dy*sin(th)", initial = "0", unit = "m" }
y  = { next = "y + dx*sin(th) + dy*cos(th)", initial = "0", unit = "m" }
th = { next = "th + dt", initial = "0", unit = "rad" }

[outputs]
)toml";
  for (std::size_t k = 0; k < 3; ++k) {
    toml += pose_columns[k] + " = { value = \"" + pose_states[k] + "\", unit = \"" + (k < 2 ? "m" : "rad") + "\"" +
            noise_entry(with_noise, system.noise[k]) + " }\n";
  }
  toml += "\n[planar]\nx = \"x\"\ny = \"y\"\nheading = \"th\"\nforward = \"dx\"\nlateral = \"dy\"\nturn = \"dt\"\n";
  return toml + parameters_toml(system);
}

void draw_parameters(Random& random, System& system, std::size_t count) {
  const double size[3] = {0.003, 0.003, 0.02};  // of the offsets [m, m, rad]
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto offset = [&] {
      const double value = random.uniform(-1, 1) * size[axis];
      system.parameters.push_back({axes[axis] + "_offset", axis < 2 ? "m" : "rad", value, 0, -0.1, 0.1, false});
    };
    if (count > 3) offset();
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == axis) {
        system.parameters.push_back(guessed(random, axes[axis] + "_gain", "1", random.uniform(0.75, 1.25)));
      } else if (count == 12) {
        const double ratio = 0.1 * top_order[axis] / top_order[k];
        system.parameters.push_back({axes[axis] + "_by_" + order_names[k],
                                     axis == 2 ? "rad/m"
                                     : k == 2  ? "m/rad"
                                               : "1",
                                     random.uniform(-1, 1) * ratio, 0, -10 * ratio, 10 * ratio, false});
      }
    }
  }
}

void record_walk(Random& random, System& system) {
  const std::size_t sequences = system.final_only ? 60 : 16;
  for (std::size_t i = 0; i < sequences; ++i) {
    Recording recording;
    recording.name = "rec_" + std::string(i + 1 < 10 ? "0" : "") + std::to_string(i + 1) + ".csv";
    const std::size_t steps = system.final_only ? 22 + random.index(7) : 40 + random.index(21);
    recording.inputs.assign(3, {});
    Triple order{};
    std::size_t left = 0;
    for (std::size_t row = 0; row < steps; ++row) {
      if (left-- == 0) {
        left = 2 + random.index(system.final_only ? 12 : 6);
        for (std::size_t k = 0; k < 3; ++k) order[k] = rounded(random.uniform(-1, 1) * top_order[k], 1e-3);
        if (random.chance(0.7)) order[0] = std::abs(order[0]);
      }
      for (std::size_t k = 0; k < 3; ++k) recording.inputs[k].push_back(order[k]);
    }
    for (Column& column : recording.inputs) column.push_back(0);
    recording.initial = {0, 0, 0};
    system.recordings.push_back(recording);
  }
}

}  // namespace

Simulate walk_simulation(const Values& process_noise) {
  return [process_noise](const Values& p, const std::vector<Fault>& faults, const Recording& recording,
                         const How& how) { return simulate(p, faults, recording, how, process_noise); };
}

System walk(Random& random, bool final_only) {
  System system;
  system.family = final_only ? "walk_final" : "walk";
  system.model_name = final_only ? "walk, final poses" : "walk";
  system.final_only = final_only;
  system.stepwise = !final_only;
  draw_parameters(random, system, random.choice(std::vector<std::size_t>{3, 6, 12}));
  system.inputs = order_columns;
  system.outputs = pose_columns;
  system.noise = {0.01, 0.01, 0.035};  // by tape [m, m, rad]
  if (!final_only) system.noise = {random.uniform(0.001, 0.004), 0, random.uniform(0.003, 0.012)};
  if (!final_only) system.noise[1] = system.noise[0];
  const double level = random.uniform(0.5, 1.3);
  system.process_noise = {0.002 * level, 0.002 * level, 0.012 * level};
  system.simulate = walk_simulation(system.process_noise);
  record_walk(random, system);
  system.model_toml = [system](bool with_noise) { return walk_toml(system, with_noise); };
  const System nominal = system;
  system.draw_named = [nominal](Random& draws) { return draw_walk_fault(draws, nominal); };
  system.draw_outside = [](Random& draws) { return draw_outside_walk_fault(draws); };
  return system;
}

}  // namespace plants

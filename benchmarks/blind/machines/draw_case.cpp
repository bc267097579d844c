#include "draw_case.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <stdexcept>

#include "../plants/calibrate.hpp"
#include "../plants/systems.hpp"
#include "free_start.hpp"
#include "laws.hpp"

namespace machines {
namespace {

using plants::Fault;
using plants::How;
using plants::Kind;
using plants::System;

constexpr int fine = 10;                // integration steps per row of the true machine
constexpr int finer = 4 * fine;         // that show whether those are enough
constexpr double unresolved = 0.3;      // of the noise: what the steps of the true machine may cost, root mean square
constexpr int coarse = 2;               // of the model that is calibrated
constexpr int tries_per_machine = 12;   // draws of effects before another machine is drawn
constexpr int machines_per_case = 200;  // before giving up
constexpr Visible visible;

double error_of(const System& system, const Values& parameters, const std::vector<Fault>& faults,
                std::span<const Recording> recordings, const How& how) {
  return plants::root_mean_square(plants::residuals(system, parameters, faults, recordings, how));
}

// As the model file says that a recording begins.
How as_user(int substeps) { return {substeps, true, false, nullptr, true}; }

struct Band {
  double low, high;
};

Band draw_band(Random& random) {
  return random.choice(std::vector<Band>{{visible.held_out, 3}, {3, 10}, {10, visible.most}});
}

// Recordings of a sound machine: all finite, every output moves.
bool is_sound(const CompiledMachine& machine, const Sizes& sizes) {
  for (const Size& size : sizes.states)
    if (!std::isfinite(size.rms) || !(size.peak < 1e9)) return false;
  for (std::size_t k = 0; k < machine.outputs.size(); ++k)
    if (!(sizes.outputs[k].spread > 1e-3 * sizes.outputs[k].peak)) return false;
  return true;
}

// Whether the steps of the true machine leave no mark: what is hidden is its physics, and not how it was integrated.
bool is_resolved(const plants::Case& one, const Values& actual, const Recording& recording) {
  const auto check = one.system.simulate(actual, one.faults, recording, How{finer, false, false, nullptr}).outputs;
  for (std::size_t k = 0; k < check.size(); ++k) {
    double squares = 0;
    for (std::size_t i = 0; i < check[k].size(); ++i) squares += std::pow(check[k][i] - recording.ideal[k][i], 2);
    if (!(squares <= std::pow(unresolved * one.system.noise[k], 2) * static_cast<double>(check[k].size())))
      return false;
  }
  return true;
}

// Runs the true machine. False if it went astray, or is not resolved.
bool read_all(Random& random, plants::Case& one, const Sizes& sizes) {
  const Values actual = plants::actual_values(one.system);
  for (Recording& recording : one.system.recordings) {
    recording.ideal = one.system.simulate(actual, one.faults, recording, How{fine, false, false, nullptr}).outputs;
    if (!is_resolved(one, actual, recording)) return false;
    for (std::size_t k = 0; k < recording.ideal.size(); ++k)
      for (const double value : recording.ideal[k])
        if (!(std::abs(value) < 20 * sizes.outputs[k].peak)) return false;
    plants::read_out(random, one.system, one.sensing, recording);
  }
  if (one.sensing.outlier) {
    Recording& struck = one.system.recordings[random.index(one.system.recordings.size())];
    if (struck.time.size() > 30) plants::add_outlier(random, one.system, struck);
  }
  return true;
}

// Where noise in the first readings costs more than this share of the true model's error, the model file says that
// initial values are to be estimated.
constexpr double tolerable_start = 0.1;

void free_sensitive_start(plants::Case& one, Machine& machine) {
  const Values actual = plants::actual_values(one.system);
  const How truth{fine, false, false, nullptr}, from_readings{fine, true, false, nullptr};
  const std::span<const Recording> all(one.system.recordings);
  const double exact = error_of(one.system, actual, one.faults, all, truth);
  if (error_of(one.system, actual, one.faults, all, from_readings) < (1 + tolerable_start) * exact) return;
  for (State& state : machine.states)
    if (state.initial.rfind("column:", 0) == 0) state.initial = "free";
}

struct Split {
  std::span<const Recording> fitted, held_out;
};

Split split(const System& system) {
  const std::span<const Recording> all(system.recordings);
  const std::size_t count = all.size() * 7 / 10;
  return {all.first(count), all.subspan(count)};
}

// Errors of parameters over those of the true model, held out and fitted to.
struct Strength {
  double held_out = 0, fitted = 0;
};

Strength strength_of(const plants::Case& one, const Values& parameters, const std::vector<Fault>& faults,
                     int substeps) {
  const Split parts = split(one.system);
  const How how = as_user(substeps), truth{fine, false, false, nullptr};
  const Values actual = plants::actual_values(one.system);
  return {error_of(one.system, parameters, faults, parts.held_out, how) /
              error_of(one.system, actual, one.faults, parts.held_out, truth),
          error_of(one.system, parameters, faults, parts.fitted, how) /
              error_of(one.system, actual, one.faults, parts.fitted, truth)};
}

// Calibrates the model without effects and notes the errors of both.
void note_errors(plants::Case& one) {
  const System& system = one.system;
  const Split parts = split(system);
  const How how = as_user(coarse), truth{fine, false, false, nullptr};
  const Values actual = plants::actual_values(system);
  one.calibrated = plants::calibrate(system, {}, parts.fitted, how);
  one.calibrated_rmse = error_of(system, one.calibrated, {}, parts.held_out, how);
  one.actual_rmse = error_of(system, actual, one.faults, parts.held_out, truth);
  one.errors.clear();
  const std::span<const Recording> all(system.recordings);
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<Recording> as_read{all[i]};
    for (std::vector<bool>& outliers : as_read[0].outliers) outliers.assign(outliers.size(), false);
    one.errors.push_back({all[i].name, i >= parts.fitted.size(),
                          error_of(system, actual, one.faults, all.subspan(i, 1), truth),
                          error_of(system, one.calibrated, {}, all.subspan(i, 1), how),
                          error_of(system, actual, one.faults, as_read, truth)});
  }
}

// Whether the effects might be visible at all: no calibration can make the error on fitted recordings larger.
bool worth_calibrating(const plants::Case& one) {
  const Strength as_true = strength_of(one, plants::actual_values(one.system), {}, coarse);
  return as_true.fitted >= visible.fitted && std::isfinite(as_true.held_out);
}

// Parameters fitted from the true ones and from those of the model without effects, whichever fit better.
Values best_calibration(const System& system, const Values& calibrated, std::span<const Recording> fitted,
                        const How& how) {
  const Values actual = plants::actual_values(system);
  Values near_calibrated = actual;  // and strengths, which that model does not have
  std::ranges::copy(calibrated, near_calibrated.begin());
  const Values a = plants::calibrate_from(system, actual, {}, fitted, how);
  const Values b = plants::calibrate_from(system, near_calibrated, {}, fitted, how);
  return error_of(system, a, {}, fitted, how) < error_of(system, b, {}, fitted, how) ? a : b;
}

// Without each effect in turn, parameters and the strength of the other fitted again.
bool each_visible(Drawn& drawn) {
  plants::Case& one = drawn.one;
  one.strength_each.clear();
  if (one.faults.size() == 1) one.strength_each = {one.strength()};
  for (std::size_t k = 0; one.faults.size() == 2 && k < 2; ++k) {
    const System without = with_free_strength(one.system, drawn.machine, {drawn.hidden[1 - k]}, 0);
    const How how = as_user(fine / 2);
    const Split parts = split(one.system);
    const Values p = best_calibration(without, one.calibrated, parts.fitted, how);
    const How truth{fine, false, false, nullptr};
    const Values actual = plants::actual_values(one.system);
    const double held_out =
        error_of(without, p, {}, parts.held_out, how) / error_of(one.system, actual, one.faults, parts.held_out, truth);
    const double fitted =
        error_of(without, p, {}, parts.fitted, how) / error_of(one.system, actual, one.faults, parts.fitted, truth);
    one.strength_each.push_back(held_out);
    if (!(held_out >= visible.held_out_each && fitted >= visible.fitted_each)) return false;
  }
  return true;
}

bool matters(Drawn& drawn, const Band& band) {
  plants::Case& one = drawn.one;
  if (one.kind == Kind::nothing) {
    note_errors(one);
    return true;
  }
  if (!worth_calibrating(one)) return false;
  note_errors(one);
  if (!(one.strength() >= band.low && one.strength() <= band.high)) return false;
  if (!(strength_of(one, one.calibrated, {}, coarse).fitted >= visible.fitted)) return false;
  return each_visible(drawn);
}

// A name first, then one of its places, so that machines with many sensors do not have faults of sensors alone.
Candidate draw_candidate(Random& random, const std::vector<Candidate>& list) {
  std::set<std::string> names;
  for (const Candidate& one : list) names.insert(one.name);
  const std::string name = random.choice(std::vector<std::string>(names.begin(), names.end()));
  std::vector<Candidate> places;
  std::ranges::copy_if(list, std::back_inserter(places), [&](const Candidate& one) { return one.name == name; });
  return random.choice(places);
}

std::vector<Hidden> draw_all(Random& random, const Grammar& grammar, const Draft& draft, const Sizes& sizes,
                             const plants::Case& one) {
  std::vector<Hidden> hidden;
  if (one.kind == Kind::nothing) return hidden;
  const bool outside = one.kind == Kind::outside;
  std::vector<Candidate> list = outside ? outside_candidates(draft.machine) : named_candidates(draft.machine);
  std::erase_if(list, [&](const Candidate& candidate) { return !is_open(grammar, candidate); });
  while (hidden.size() < (one.kind == Kind::two ? 2u : 1u)) {
    const Candidate candidate = draw_candidate(random, list);
    if (!hidden.empty() && hidden[0].name == candidate.name) continue;
    hidden.push_back(draw_hidden(random, grammar, draft.machine, sizes, candidate, one.system.noise));
  }
  return hidden;
}

// One machine, several draws of effects.
std::optional<Drawn> try_machine(Random& random, const Grammar& grammar, Draft draft, Kind kind, const Band& band) {
  Drawn drawn;
  drawn.machine = std::make_shared<const CompiledMachine>(draft.machine);
  drawn.one.kind = kind;
  drawn.one.system = system_of(random, draft, drawn.machine);
  const Sizes sizes = measure(*drawn.machine, drawn.one.system.recordings);
  if (!is_sound(*drawn.machine, sizes)) return std::nullopt;
  drawn.one.system.noise.clear();
  for (const Size& size : sizes.outputs)
    drawn.one.system.noise.push_back(three_digits(size.spread * random.log_uniform(0.002, 0.02)));
  drawn.one.sensing = plants::draw_sensing(random, false);
  drawn.one.noise_shown = random.chance(0.5);
  set_hidden(drawn.one.system, drawn.machine, {});
  for (int i = 0; i < tries_per_machine; ++i) {
    drawn.hidden = draw_all(random, grammar, draft, sizes, drawn.one);
    set_hidden(drawn.one.system, drawn.machine, drawn.hidden);
    drawn.one.faults.clear();
    for (std::size_t k = 0; k < drawn.hidden.size(); ++k) drawn.one.faults.push_back(fault_of(drawn.hidden[k], k));
    if (!read_all(random, drawn.one, sizes)) continue;
    free_sensitive_start(drawn.one, draft.machine);
    drawn.machine = std::make_shared<const CompiledMachine>(draft.machine);
    set_hidden(drawn.one.system, drawn.machine, drawn.hidden);
    if (matters(drawn, band)) return drawn;
  }
  return std::nullopt;
}

}  // namespace

bool is_signed(const std::string& name) {
  static const std::set<std::string> names{"constant_force", "constant_rate",   "sensor_bias",
                                           "sensor_scale",   "sensor_drift",    "input_asymmetry",
                                           "gravity_offset", "parameter_drift", "input_gain"};
  return names.contains(name);
}

plants::Fault fault_of(const Hidden& hidden, std::size_t index) {
  Fault fault;
  fault.name = hidden.name;
  fault.attached_to = hidden.attached_to;
  fault.also = hidden.also;
  for (const std::string& place : hidden.multiples) fault.equivalents.emplace_back(hidden.name, place);
  fault.same_formula = hidden.same_formula;
  fault.numbers = hidden.numbers;
  fault.target = static_cast<int>(index);
  return fault;
}

void set_hidden(System& system, std::shared_ptr<const CompiledMachine> machine, const std::vector<Hidden>& hidden) {
  const Machine& description = machine->machine;
  const std::vector<double> noise = system.noise;
  system.model_toml = [description, noise](bool with_noise) { return model_toml(description, noise, with_noise); };
  system.simulate = [machine, hidden, noise](const Values& parameters, const std::vector<Fault>& faults,
                                             const Recording& recording, const How& how) {
    std::vector<Hidden> present;
    for (const Fault& fault : faults) present.push_back(hidden[static_cast<std::size_t>(fault.target)]);
    return simulate_as_user(*machine, parameters, present, recording, how, noise);
  };
}

System with_free_strength(const System& system, std::shared_ptr<const CompiledMachine> machine,
                          const std::vector<Hidden>& hidden, std::size_t k) {
  System freed = system;
  const double size = std::abs(hidden[k].a);
  const double least = is_signed(hidden[k].name) ? -50 * size : 1e-3 * size;
  const bool read_off = rounds(hidden[k].law);  // the steps of readings are seen as they are
  freed.parameters.push_back({"strength", "", hidden[k].a, hidden[k].a, least, 50 * size, read_off});
  const std::vector<double> noise = system.noise;
  freed.simulate = [machine, hidden, noise, k](const Values& values, const std::vector<Fault>&,
                                               const Recording& recording, const How& how) {
    std::vector<Hidden> present = hidden;
    present[k].a = values.back();
    return simulate_as_user(*machine, Values(values.begin(), values.end() - 1), present, recording, how, noise);
  };
  return freed;
}

System system_of(Random& random, const Draft& draft, std::shared_ptr<const CompiledMachine> machine) {
  System system;
  system.family = draft.machine.family;
  system.model_name = draft.machine.title;
  system.parameters = draft.machine.parameters;
  for (const Input& one : draft.machine.inputs) system.inputs.push_back(one.column);
  for (const Output& one : draft.machine.outputs) system.outputs.push_back(one.column);
  system.noise.assign(system.outputs.size(), 1);
  system.recordings = draw_recordings(random, draft);
  set_hidden(system, std::move(machine), {});
  return system;
}

Drawn draw_case(Random& random, const Grammar& grammar, const std::string& family, Kind kind) {
  for (int i = 0; i < machines_per_case; ++i) {
    // A band that no effect of this machine falls in is given up in the end.
    const Band band = i < machines_per_case / 2 ? draw_band(random) : Band{visible.held_out, 10 * visible.most};
    Draft draft = draw_machine(random, grammar, family);
    draft.machine.linear_inputs = grammar.linear_inputs;
    if (auto drawn = try_machine(random, grammar, draft, kind, band)) return *drawn;
  }
  throw std::runtime_error("no case of family " + family + " was strong enough");
}

}  // namespace machines

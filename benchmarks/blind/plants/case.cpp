#include "case.hpp"

#include <cmath>
#include <span>
#include <stdexcept>

#include "calibrate.hpp"
#include "systems.hpp"

namespace plants {
namespace {

constexpr double least_strength = 1.2;
constexpr double least_strength_each = 1.12;  // of two faults
// On the recordings that the nominal parameters were fitted to: a calibrated model without faults cannot come close to
// the true one there, unless the faults hardly matter. Keeps luck with few held-out recordings from deciding.
constexpr double least_fitted_strength = 1.08;
constexpr double least_fitted_strength_each = 1.04;
constexpr double least_step_strength = 1.03;
constexpr int fine = 10;  // integration steps per row of the true machine

System draw_system(Random& random, const std::string& family) {
  if (family == "servo") return servo(random);
  if (family == "carriage") return carriage(random);
  if (family == "tanks") return tanks(random);
  if (family == "walk") return walk(random, false);
  if (family == "walk_final") return walk(random, true);
  throw std::invalid_argument("unknown family " + family + "; known: servo, carriage, tanks, walk, walk_final");
}

// The first fault has the wanted name, if one is wanted.
std::vector<Fault> draw_faults(Random& random, const System& system, Kind kind, const std::string& wanted) {
  if (kind == Kind::nothing) return {};
  const auto draw = [&] { return kind == Kind::outside ? system.draw_outside(random) : system.draw_named(random); };
  std::vector<Fault> faults{draw()};
  for (int i = 0; i < 500 && !wanted.empty() && faults[0].name != wanted; ++i) faults[0] = draw();
  while (kind == Kind::two && faults.size() < 2) {
    const Fault fault = system.draw_named(random);
    if (fault.name != faults[0].name) faults.push_back(fault);
  }
  return faults;
}

// Runs the true machine. False if it went astray.
bool measure(Random& random, Case& one) {
  const bool walks = !one.system.process_noise.empty();
  for (Recording& recording : one.system.recordings) {
    How how{fine, false, false, walks ? &random : nullptr};
    recording.ideal = one.system.simulate(actual_values(one.system), one.faults, recording, how).outputs;
    for (const Column& column : recording.ideal)
      for (double value : column)
        if (!(std::abs(value) < 1e3)) return false;
    read_out(random, one.system, one.sensing, recording);
  }
  if (one.sensing.outlier)
    add_outlier(random, one.system, one.system.recordings[random.index(one.system.recordings.size())]);
  return true;
}

double error_of(const System& system, const Values& parameters, const std::vector<Fault>& faults,
                std::span<const Recording> recordings, const How& how) {
  return root_mean_square(residuals(system, parameters, faults, recordings, how));
}

void judge(Case& one) {
  const System& system = one.system;
  const Values actual = actual_values(system);
  const std::size_t count = system.recordings.size(), fitted = count * 7 / 10;
  const std::span<const Recording> all(system.recordings), fit = all.first(fitted), held_out = all.subspan(fitted);
  const How coarse{2, true, system.stepwise, nullptr}, full{2, true, false, nullptr},
      true_full{fine, false, false, nullptr};
  one.calibrated = calibrate(system, {}, fit, coarse);
  one.calibrated_rmse = error_of(system, one.calibrated, {}, held_out, full);
  one.actual_rmse = error_of(system, actual, one.faults, held_out, true_full);
  one.errors.clear();
  for (std::size_t i = 0; i < count; ++i) {
    one.errors.push_back({system.recordings[i].name, i >= fitted,
                          error_of(system, actual, one.faults, all.subspan(i, 1), true_full),
                          error_of(system, one.calibrated, {}, all.subspan(i, 1), full), 0});
  }
  if (system.stepwise) {
    const How steps{1, false, true, nullptr};
    one.actual_step_rmse = error_of(system, actual, one.faults, held_out, steps);
    one.calibrated_step_rmse = error_of(system, one.calibrated, {}, held_out, steps);
  }
}

// How far the model without the fault is from the true one: on held-out recordings, and on those it was fitted to.
struct Strength {
  double held_out = 0, fitted = 0;
};

Strength strength_of(const Case& one, const Values& parameters, const std::vector<Fault>& faults, int substeps) {
  const std::span<const Recording> all(one.system.recordings);
  const std::size_t count = all.size() * 7 / 10;
  const bool steps = one.system.stepwise;
  const How full{substeps, true, false, nullptr}, as_fitted{substeps, true, steps, nullptr};
  const How truth{fine, false, false, nullptr}, true_steps{fine, false, steps, nullptr};
  const Values actual = actual_values(one.system);
  return {error_of(one.system, parameters, faults, all.subspan(count), full) /
              error_of(one.system, actual, one.faults, all.subspan(count), truth),
          error_of(one.system, parameters, faults, all.first(count), as_fitted) /
              error_of(one.system, actual, one.faults, all.first(count), true_steps)};
}

// How much worse the model gets without each fault in turn, its parameters calibrated again.
bool judge_each(Case& one) {
  const std::span<const Recording> all(one.system.recordings);
  const std::size_t fitted = all.size() * 7 / 10;
  one.strength_each.clear();
  if (one.faults.size() == 1) one.strength_each = {one.strength()};
  for (std::size_t k = 0; one.faults.size() > 1 && k < one.faults.size(); ++k) {
    std::vector<Fault> others = one.faults;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const How how{5, true, one.system.stepwise, nullptr};
    const Values p = calibrate(one.system, others, all.first(fitted), how);
    const Strength strength = strength_of(one, p, others, 5);
    one.strength_each.push_back(strength.held_out);
    if (!(strength.held_out >= least_strength_each && strength.fitted >= least_fitted_strength_each)) return false;
  }
  return true;
}

// Bands of strength, so that weak and strong faults are equally frequent.
struct Band {
  double low, high;
};

Band draw_band(Random& random) { return random.choice(std::vector<Band>{{least_strength, 3}, {3, 10}, {10, 80}}); }

bool strong_enough(Case& one, const Band& band) {
  if (one.kind == Kind::nothing) return true;
  if (!(one.strength() >= band.low && one.strength() <= band.high)) return false;
  if (!(strength_of(one, one.calibrated, {}, 2).fitted >= least_fitted_strength)) return false;
  if (one.system.stepwise && one.calibrated_step_rmse < least_step_strength * one.actual_step_rmse) return false;
  return judge_each(one);
}

}  // namespace

std::string name_of(Kind kind) {
  switch (kind) {
    case Kind::nothing:
      return "nothing";
    case Kind::one:
      return "one";
    case Kind::two:
      return "two";
    default:
      return "outside";
  }
}

Case draw_case(Random& random, const std::string& family, Kind kind) {
  Band band = draw_band(random);
  // Name and band are drawn first and kept for a while: effects that are mostly too weak would else be rare.
  std::string wanted;
  if (kind != Kind::nothing) wanted = draw_faults(random, draw_system(random, family), kind, "")[0].name;
  for (int attempt = 0; attempt < 500; ++attempt) {
    if (attempt == 40) band = {least_strength, 200};
    if (attempt == 100) wanted.clear();
    Case one;
    one.kind = kind;
    one.system = draw_system(random, family);
    one.sensing = draw_sensing(random, one.system.final_only);
    one.noise_shown = random.chance(0.5);
    one.faults = draw_faults(random, one.system, kind, wanted);
    if (!measure(random, one)) continue;
    judge(one);
    if (strong_enough(one, band)) return one;
  }
  throw std::runtime_error("no case of family " + family + " was strong enough in 500 draws");
}

}  // namespace plants
